"""Chapter: instructions of fixed queries, which no load changes; every run of the tests checks the counts."""

import json
import pathlib

from query_instructions import LIMIT
from report.text import number, table

PROGRAMS = []  # no benchmark: scripts/query_instructions.py counts, and keeps the counts in perf/


def chapter(_results, _pictures):
    file = pathlib.Path(__file__).parents[2] / "perf/query_instructions.json"
    if not file.exists():
        raise SystemExit(f"report: {file} is not there: scripts/query_instructions.sh --update makes it")
    counted = json.loads(file.read_text())
    rows, ticks = [], []
    for query in counted["queries"]:
        tests, instructions = query["sphere_tests"], query["instructions"]
        row = [f"`{query['name']}`", f"{instructions:,}", f"{tests:,}" if tests else "–"]
        if query["name"].startswith("ticks/"):  # of which the search is a part
            ticks.append([*row, "–"])
        else:
            rows.append([*row, number(instructions / tests) if tests else "–"])
    context = counted["context"]
    return [
        "## Instructions",
        "",
        f"Instructions of {len(rows)} fixed queries of the built-in jaws, as callgrind counts them: one query, one worker "
        f"on AVX2, without building; and of {context['ticks']} ticks of {len(ticks)} scenes, in which a ball sinks on a box and slides. "
        "Counts depend on neither load nor clock, so every run of the tests with this compiler repeats them, and fails if one differs by over "
        f"{100 * LIMIT:g} %. They are no times: a vector instruction counts as one, and so does one that waits for memory.",
        "",
        *table(["query", "instructions", "sphere tests", "instructions a test"], rows + ticks),
        "",
        "Repeated by the test `QueryInstructions`.",
        "",
        f"Compiled by {context['compiler']}, `{context['flags']}`: the build of the tests, with its assertions. "
        "`within_20000_tests` ends by its budget. "
        "`distance`, `intersects` and `triangle_pairs` ask about triangles: their tests compare clusters of triangles, and cost more.",
    ]
