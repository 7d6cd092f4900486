"""What the sections of scaling share: the program, the colours, and how often a point was asked."""

PROGRAM = "scaling_bench"
COLOURS = ("#1b9e77", "#d95f02", "#7570b3", "#e7298a")


def queries(runs):
    """How often each point of a plot was asked."""
    (count,) = {int(run["rounds"]) for run in runs}
    return f"n = {count:,} queries a point"
