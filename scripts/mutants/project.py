"""Faults in figures, the package and the pages."""

from .mutant import Mutant, PAGES

MUTANTS = [
    # Figures.
    Mutant("ratio-of-itself", "a ratio of leaf pairs compares a query with itself",
           [("src/cli/commands/bench.cpp", "ways[*way.over].quantile(0.5) / way.quantile(0.5)", "way.quantile(0.5) / way.quantile(0.5)")],
           ["cli_test Bench.*"]),
    Mutant("stale-figures-pass", "figures that are older than their code are no failure",
           [("scripts/report/figures.py", "return 1 if found else 0", "return 0")], ["python figures_test.py History"]),
    Mutant("comments-age-figures", "a comment that changes makes figures stale",
           [("scripts/report/figures.py", "    return \" \".join(without.split())", "    return text")], ["python figures_test.py History"]),
    Mutant("report-mixes-codes", "results of other code count as results of this one",
           [("scripts/report/runner.py", " and not changed_since(commit, program)", "")], ["python figures_test.py Missing"]),
    Mutant("long-runs-of-other-code", "a long test that passed at any commit counts",
           [("scripts/test.sh", "grep -qsx \"$commit\"", "grep -qs .")], ["python long_test.py"]),

    # The report.
    Mutant("verdict-always-agrees", "the worst case is right before collision wherever it is",
           [("scripts/report/seed.py", "\"*Agrees*\" if r[\"beyond\"] in (0, 1) else", "\"*Agrees*\" if True else")], ["python report_test.py"]),
    Mutant("win-against-nobody", "a pose at which no other counts is a win",
           [("scripts/report/peers.py", "        if other is None:\n            continue\n",
             "        if other is None:\n            count += 1\n            continue\n")],
           ["python report_test.py"]),
    Mutant("away-hidden", "queries that were off their core count among those that the quantiles are of",
           [("scripts/report/timing.py", "number(r[\"n\"] - r[key])", "number(r[\"n\"])")], ["python report_test.py"]),
    Mutant("losses-plain", "a loss of the report is not bold",
           [("scripts/report/tables.py", "if is_bold and is_bold(row) else text", "if False else text")], ["python report_test.py"]),

    # The package.
    Mutant("export-map-loosened", "symbols of other libraries are exported too",
           [("src/package/ist.map.in", "      ist::*;", "      *;")], ["ctest Package.Symbols"]),
    Mutant("private-exported", "private members of public classes are exported",
           [("src/ist/query/query_state.h", "struct QueryState {", "struct __attribute__((visibility(\"default\"))) QueryState {")],
           ["ctest Package.Symbols"]),
    Mutant("vtables-kept-in", "the vtable of a public class is no longer exported",
           [("src/package/ist.map.in", "      vtable?for?ist::*;\n", "")], ["ctest Package.Symbols"]),
    Mutant("header-left-at-home", "a header that another one includes is not installed",
           [("src/package/public_headers.txt", "ist/query/manifold.h\n", "")], ["ctest Package.Headers"]),
    Mutant("choices-as-files", "bash completes the name of a file where a word of a fixed set belongs",
           [(PAGES + "bash_completion.cpp", "if (option.value.empty()) continue;",
             "if (option.value.empty() || !option.choices.empty()) continue;")], ["ctest Package.Completion"]),
    Mutant("installed-links-astray", "links of the installed documents lead to where the sources have things",
           [("src/package/documents.cmake", "set(place examples/${CMAKE_MATCH_1})", "set(place src/${CMAKE_MATCH_1})")],
           ["ctest Package.Documents"]),
    Mutant("uninstall-takes-others", "uninstalling removes what others have put beside it",
           [("src/package/uninstall.cmake.in", "if(others)", "if(FALSE)")], ["ctest Package.Uninstall"]),

    # The pages.
    Mutant("key-without-a-default", "the reader of scenes does not say what a key is where it is absent",
           [("src/ist/scene/table_reader.cpp", "if (!otherwise.empty()) noted", "if (false) noted")], ["ctest Docs.SceneReference"]),
    Mutant("left-without-a-reason", "a page's code may be left without a reason",
           [("tests/docs/pages.py", r"output varies), \S.*", "output varies).*")], ["ctest Docs.Refusals"]),
    Mutant("scripts-left-unnamed", "HACKING may leave out a script",
           [("tests/docs/names.py", "sorted(needed - named)", "sorted(needed - needed)")], ["ctest Docs.Refusals"]),
    Mutant("guards-end-at-the-line", "tests that an invariant names after a line's end may be missing",
           [("tests/docs/guards.py", r"(?:,\s+)?)*)", "(?:, )?)*)")], ["ctest Docs.Refusals"]),
]
