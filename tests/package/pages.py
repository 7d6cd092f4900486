"""The manual pages and the completion for bash, held against --help."""

import os
import pty
import re
import select
import subprocess

from checks import need, require, run

SECTIONS = ["NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "EXIT STATUS", "EXAMPLES", "SEE ALSO"]
# help2man breaks no line, and names the month alone.
ACCEPTED = ["STYLE: input text line longer than 80 bytes", "WARNING: cannot parse date, using it verbatim"]
# Asks the completion without a terminal: prints what it offers, a line each, and what it asks of readline.
ASK = """source "$1"; shift
compopt() { echo "compopt $*"; }
COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
_ist
((${#COMPREPLY[@]} == 0)) || printf '%s\\n' "${COMPREPLY[@]}"
"""


class Help:
    """What --help says of the command or of a subcommand."""

    def __init__(self, command, *words):
        self.text = run(command, *words, "--help")
        self.values = {}  # each spelling, and the type of its value, empty for a flag
        self.arguments = re.findall(r"^  ([A-Z]+) FILE\b", self.text, re.M)
        for spellings, value in re.findall(r"^  (-\S+)(?: ([A-Z]\S*))?", self.text, re.M):
            self.values.update({each: "" if value.startswith(("Excludes", "Needs")) else value for each in spellings.split(",")})


def choices_of(value):
    found = re.search(r"{(.*?)}", value)
    return found[1].split(",") if found else []


class Pages:
    prefix = None  # of an install tree

    def helps(self):
        """The command's own help under "ist", and each subcommand's under its name."""
        command = self.prefix / "bin/ist"
        first = Help(command)
        names = re.findall(r"^  ([a-z]+) ", first.text.split("\nSubcommands:\n")[1], re.M)
        require(len(names) >= 10 and "occlusion" in names, f"the subcommands are {names}")
        return {"ist": first, **{name: Help(command, name) for name in names}}

    def man_pages(self):
        return sorted((self.prefix / "share/man/man1").iterdir())

    def ManPages(self):
        """Each subcommand has one, and each option of --help is an entry there, with its value."""
        need("help2man")
        helps = self.helps()
        names = sorted(["ist.1", *(f"ist-{name}.1" for name in helps if name != "ist")])
        require([page.name for page in self.man_pages()] == names, f"the pages are {self.man_pages()}")
        for name, told in helps.items():
            page = self.prefix / "share/man/man1" / ("ist.1" if name == "ist" else f"ist-{name}.1")
            text = re.sub(r"\\f(\(CW|.)|\\[,/]", "", page.read_text().replace("\\-", "-"))
            sections = re.findall(r'^\.SH "?(.*?)"?$', text, re.M)
            require(sections == SECTIONS, f"{page} has the sections {sections}")
            entries = {}
            for spellings, rest in re.findall(r"^\.TP\n(-[\w-]+(?:, -[\w-]+)*)(.*)$", text.split(".SH OPTIONS\n")[1], re.M):
                entries.update({spelling: rest for spelling in spellings.split(", ")})
            require(entries.keys() == told.values.keys(), f"{page} has {set(entries) ^ set(told.values)} alone, or lacks it")
            for spelling, value in told.values.items():
                require(not value.startswith("TEXT") or choices_of(value),
                        f"ist {name} {spelling}: type_name() has to say whether its text is a FILE")
                shown = entries[spelling].replace("Excludes:", "Needs:").split(" Needs:")[0]
                require(shown.startswith(f" {value}") if value else not shown, f"{page} shows {spelling} {value} as{shown}")
            for argument in told.arguments:
                require(f".TP\n{argument} FILE" in text, f"{page} lacks {argument}")
            examples = re.findall(r"^\$ (.*)$", text, re.M)
            require(examples and all(example.startswith("ist ") for example in examples), f"{page} has no examples")
            require(name == "ist" or all(example in told.text for example in examples), f"{page} shows {examples}")
            require("medical device" in text and "avx" not in text, f"{page} lacks the purpose, or tells of this machine")

    def ManPagesAreClean(self):
        """groff and apropos find nothing to say against them, and mandoc nothing but what is accepted."""
        need("help2man", "man", "mandoc", "lexgrog")
        plain = {**os.environ, "LC_ALL": "C.UTF-8", "MANWIDTH": "80"}
        for page in self.man_pages():
            said = subprocess.run(["man", "--warnings", "-E", "UTF-8", "-l", page], capture_output=True, text=True,
                                  env=plain, check=False)
            require(said.returncode == 0 and said.stderr == "", f"man of {page}:\n{said.stderr}")
            require(all(re.search(rf"^{section}$", said.stdout, re.M) for section in SECTIONS), said.stdout)
            lint = subprocess.run(["mandoc", "-T", "lint", page], capture_output=True, text=True, check=False)
            said = [line for line in lint.stdout.splitlines() if not any(each in line for each in ACCEPTED)]
            require(not said, f"mandoc of {page}:\n{lint.stdout}")
            require(f'"{page.stem} - ' in run("lexgrog", page), f"apropos would not find {page}")

    def completed(self, *words):
        script = self.prefix / "share/bash-completion/completions/ist"
        return run("bash", "--norc", "-c", ASK, "bash", script, "ist", *words).splitlines()

    def Completion(self):
        """What bash offers, for each subcommand and each option of --help."""
        helps = self.helps()
        names = [name for name in helps if name != "ist"]
        no_files = "compopt +o default"
        require(self.completed("") == [no_files, *names, "help", "version", *helps["ist"].values], f"{self.completed('')}")
        require(self.completed("help", "") == [no_files, *names], "after help there are not the subcommands alone")
        require(self.completed("ap") == [no_files, "approach"], f"for ap there are {self.completed('ap')}")
        require(self.completed("nonsense", "-") == [], "an unknown subcommand has options")
        for name in names:
            values = helps[name].values
            require(self.completed(name, "-") == [no_files, *values], f"ist {name} -: {self.completed(name, '-')}")
            require((self.completed(name, "") == []) == bool(helps[name].arguments), f"ist {name} takes files, or no files")
            for spelling, value in values.items():
                if value == "":
                    continue
                expected = [no_files, *choices_of(value)]
                if value.startswith(("FILE", "FOLDER")):
                    expected = []
                require(self.completed(name, spelling, "") == expected,
                        f"ist {name} {spelling}: {self.completed(name, spelling, '')}, not {expected}")
        require(self.completed("build", "m.stl", "--spheres", "=", "t") == [no_files, "table", "tight"], "--spheres=t")
        require(self.completed("build", "m.stl", "--unit", "=") == [no_files, "mm", "m", "inch", "um", "µm"], "--unit=")

    def CompletionInTerminal(self):
        """Typed into a bash, with tabs: subcommand, file, option and value."""
        folder = self.fresh("completion")
        (folder / "upper_jaw.stl").touch()
        script = self.prefix / "share/bash-completion/completions/ist"
        pid, terminal = pty.fork()
        if pid == 0:
            os.chdir(folder)
            os.environ.update({"INPUTRC": "/dev/null", "HISTFILE": "/dev/null", "TERM": "dumb", "LC_ALL": "C.UTF-8"})
            os.execvp("bash", ["bash", "--norc", "--noprofile", "-i"])
        os.write(terminal, f"source '{script}'\nist() {{ printf '<%s>' \"$@\"; }}\n".encode())
        os.write(terminal, b"ist occl\tup\tlower.stl --num\tf\t--json; exit\n")
        shown = b""
        while select.select([terminal], [], [], 300)[0]:
            try:
                shown += os.read(terminal, 4096)
            except OSError:  # the shell has ended
                break
        os.waitpid(pid, 0)
        text = shown.decode(errors="replace")
        require("<occlusion><upper_jaw.stl><lower.stl><--numbering><fdi><--json>" in text, f"bash shows:\n{text}")
