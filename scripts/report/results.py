"""Raw results of the benchmark programs, as Google Benchmark writes them: one JSON file a program."""

import json
import pathlib


class Run(dict):
    """One benchmark: its counters by name, with `parts`, its name cut at each '/'."""

    def __init__(self, raw):
        super().__init__(raw)
        self.parts = raw["name"].split("/iterations:")[0].split("/")


class Results:
    """All results of one machine. A run that a table asks for and that is not there is an error."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self._read = {}

    def _file(self, program):
        if program not in self._read:
            self._read[program] = json.loads((self.folder / f"{program}.json").read_text())
        return self._read[program]

    def made(self, program):
        """Whether a program has results."""
        return program in self._read or (self.folder / f"{program}.json").exists()

    def context(self, program):
        """Of a program's run: processor, compiler, flags, commit, load_avg, date."""
        return self._file(program)["context"]

    def _found(self, program, first):
        found = map(Run, self._file(program)["benchmarks"])
        return [run for run in found if run.get("run_type") != "aggregate" and tuple(run.parts[: len(first)]) == first]

    def has(self, program, *first):
        """Whether a program made any run whose name begins with these parts."""
        return bool(self._found(program, first))

    def runs(self, program, *first):
        """The runs whose names begin with these parts, in the order they were made in."""
        found = self._found(program, first)
        failed = [run for run in found if run.get("error_occurred")]
        if failed:
            raise SystemExit(f"report: {program}: {failed[0]['name']}: {failed[0]['error_message']}")
        if not found:
            raise SystemExit(f"report: {self.folder / program}.json has no {'/'.join(first)}: remove it, and run again")
        return found
