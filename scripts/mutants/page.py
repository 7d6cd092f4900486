"""Faults in the page, and in what the command writes into it."""

from .mutant import Mutant, PAGE, PAGE_DATA

MUTANTS = [
    Mutant("map-of-other-settings", "a map that ends after its settings were changed is shown as one of the new",
           [(PAGE + "follow.js", "if (now.trees === trees && same)", "if (now.trees === trees)")], ["node follow_test.mjs"]),
    Mutant("map-outlives-its-pose", "a map that is measured while a hand begins to drag keeps the next one waiting",
           [(PAGE + "follow.js", "    measurer.drop('occlusion');\n", "")], ["node follow_test.mjs"]),
    Mutant("gone-worker-answers", "the page takes answers of a Worker that was ended",
           [(PAGE + "engine/engine_client.js", "=> to === worker && take(data)", "=> take(data)")], ["node engine_client_test.mjs"]),
    Mutant("old-bodies-restored", "a new Worker gets the bodies that were meant for the one before",
           [(PAGE + "engine/engine_client.js", "life === lives ? ask(name, asked, byRestore) : new Promise(() => {})",
             "ask(name, asked, byRestore)")], ["node engine_client_test.mjs"]),
    Mutant("pose-of-others-kept", "two bodies that came in place of a bite's begin at the bite's pose",
           [(PAGE + "bodies_loader.js", "home: both ? [...identity] : home", "home")], ["node bodies_loader_test.mjs"]),
    Mutant("address-without-rest", "the address is written with each change, which browsers refuse",
           [(PAGE + "state/address.js", "if (!waits && written.length < free)", "if (!waits)")], ["node address_test.mjs"]),
    Mutant("ticks-twice", "a recording in which a tick comes twice is played",
           [(PAGE + "recording/recording.js", "line.tick <= previous.tick", "line.tick < previous.tick")], ["node recording_test.mjs"]),
    Mutant("names-end-the-data", "a name in the page's data can end its element",
           [(PAGE_DATA + "page_file.cpp", "std::min(json.find('<', begin), json.size())", "json.size()")],
           ["cli_test View.NoNameEnds*"]),
    Mutant("names-in-trees", "without names, a page's trees still hold them",
           [(PAGE_DATA + "page_blocks.cpp", "questions.no_names ? without_name(tree) : tree", "tree")], ["cli_test View.ABite*"]),
    Mutant("held-in-the-scene", "a held body lies in the scene where it should lie in the tool's frame",
           [(PAGE_DATA + "recording_block.cpp", "pose_json(to_tool * pose)", "pose_json(pose)")], ["cli_test View.ARecording*"]),
]
