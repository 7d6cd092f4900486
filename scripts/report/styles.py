"""Colours and marks of the report's plots; known without the library that draws them."""

# Each policy and engine has one colour and one mark in all plots, so that they differ without colours too.
STYLE = {
    "simple": ("#888888", "s"),
    "table": ("#d95f02", "o"),
    "tight": ("#7570b3", "^"),
    "slab": ("#1b9e77", "D"),
    "exact": ("#e7298a", "*"),
    "touches": ("#e6ab02", "P"),
}


def style(name, **more):
    """Colour and mark of a policy or engine, for plot()."""
    colour, mark = STYLE[name]
    return {"color": colour, "marker": mark, "label": name} | more
