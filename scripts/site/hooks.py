"""Lets mkdocs read pages as GitHub does, and puts the reference of doxygen into the navigation."""

import re

from mkdocs.structure.nav import Link


def github_slug(heading, _separator):
    """The name that GitHub gives a heading; tests/docs/links.py has the same rule."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def on_config(config, **_):
    config["mdx_configs"]["toc"] = {**config["mdx_configs"].get("toc", {}), "slugify": github_slug}
    return config


def on_nav(nav, **_):
    nav.items.append(Link("Reference of C++ and C", "reference/index.html"))
    return nav


def on_page_markdown(markdown, **_):
    """Leaves out notes to the tests, and adapts lists. GitHub indents the parts of an item by two or three columns, mkdocs by four. mkdocs knows
    neither boxes to tick nor fences in lists: code is indented by four more columns than the text of its item."""
    lines, fenced, code, item = [], False, False, 4
    for line in re.sub(r"(?ms)^<!-- .*?-->\n", "", markdown).split("\n"):
        if line.startswith("```"):
            fenced = not fenced
        elif not fenced and re.match(" {2,3}```", line):
            code = not code
            line = ""
        elif code:
            line = " " * (item + 2) + line
        elif not fenced and (marked := re.match(r"( *)((?:-|\d+\.) )(\[ \])?", line)):
            item = 2 * len(marked[1]) + 4
            line = " " * (item - 4) + marked[2] + ("☐" if marked[3] else "") + line[marked.end():]
        elif not fenced:
            line = re.sub(r"^ {2,3}(?=\S)", " " * 4, line)
        lines.append(line)
    return "\n".join(lines)
