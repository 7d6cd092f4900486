"""What queries cost in instructions, which no load changes: the counts that every run of the tests checks."""

import json
import pathlib

from report.text import number, table

PROGRAMS = []  # no benchmark: scripts/query_instructions.py counts, and keeps the counts in perf/


def chapter(_results, _pictures):
    file = pathlib.Path("perf/query_instructions.json")
    if not file.exists():
        raise SystemExit(f"report: {file} is not there: scripts/query_instructions.sh --update makes it")
    counted = json.loads(file.read_text())
    rows = []
    for query in counted["queries"]:
        tests, instructions = query["sphere_tests"], query["instructions"]
        rows.append([f"`{query['name']}`", f"{instructions:,}", f"{tests:,}" if tests else "–",
                     number(instructions / tests) if tests else "–"])
    context = counted["context"]
    return [
        "## Instructions",
        "",
        f"{len(rows)} fixed queries of the built-in jaws, as callgrind counts them: what one query executes, one worker "
        "on AVX2, all that is built before left out. Counts depend on neither load nor clock, so every run of the tests, "
        "where the compiler is this one, repeats them, and fails where one is over 1 % more or less than here. They are no times: a vector "
        "instruction counts as one, and so does one that waits for memory.",
        "",
        *table(["query", "instructions", "sphere tests", "instructions a test"], rows),
        "",
        f"Of {context['compiler']}, `{context['flags']}`: the build that the tests run on, with its assertions. "
        "`within_20000_tests` ends by its budget. "
        "`gap`, `touches` and `collide_exact` are about triangles: their tests are of clusters of these, and cost more.",
    ]
