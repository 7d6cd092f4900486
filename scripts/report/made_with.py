"""The last chapter: the machine, and the runs of the programs."""

from report.text import table


def machine_of(context):
    """Returns a sentence on the machine and the compiler of a program's run."""
    caches = ", ".join(f"L{c['level']} {c['type'].lower()} {c['size'] // 1024} KiB" for c in context["caches"])
    return (f"{context['processor']}, {context['num_cpus']} cores at {context['mhz_per_cpu']} MHz; {caches}. "
            f"{context['compiler']}; `{context['flags']}`.")


def made_with(results, programs):
    """Returns the markdown of the chapter."""
    rows, machines, commits = [], [], []
    for program in programs:
        c = results.context(program)
        machine = machine_of(c)
        if machine not in machines:
            machines.append(machine)
        load = ", ".join(f"{value:.1f}" for value in c["load_avg"])
        commits.append(c["commit"])
        rows.append([f"`{program}`", machines.index(machine) + 1, c["commit"], c["date"][:16].replace("T", " "), float(c["seconds"]), load,
                     f"{c['loop_before']}, {c['loop_after']}"])
    mixed = ["**Not all of it was measured on one machine: compare within a chapter, and not across machines.**", ""] if len(machines) > 1 else []
    if len(set(commits)) > 1:
        mixed += [f"**Not all of it is of one commit, but of {', '.join(dict.fromkeys(commits))}: below each table stands whether its code has "
                  "changed since.**", ""]
    return ["## What it was made with", "", *(f"{number}. {machine}" for number, machine in enumerate(machines, 1)), "", *mixed,
            *table(["program", "machine", "commit", "begun", "seconds", "load when it began (1, 5, 15 minutes)",
                    "fixed loop before and after, µs"], rows), "",
            "A + after a commit says that the code had changes beside it. The fixed loop reads no memory: its time shows the clock of the "
            "core and other work on it."]
