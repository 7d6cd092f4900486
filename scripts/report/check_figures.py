"""Names stale figures: see scripts/check_figures.sh."""

import sys

from report.figures import PAGES, ROOT, SHOWN, changed_since, has_history, is_commit, rooms, shown_commit, sources_of, stamps_in, tables_in


def unstamped(page):
    """Yields a line of text for each table of the page that names no commit."""
    for number, is_stamped in tables_in(page):
        if not is_stamped:
            yield (f"{page}:{number}: the table names neither the commit that it was measured at nor a test, "
                   "of those that ctest knows, that repeats it")


def verdict(commit, maker):
    """Returns what is wrong with figures of a maker at a commit, or nothing."""
    if not is_commit(commit):
        return f"measured at {commit}, which is no commit of this history"
    changed = changed_since(commit, maker)
    files = f"{len(changed)} file{'s' if len(changed) > 1 else ''}"
    return changed and f"measured at {commit} by {maker}; since then {files} changed in {rooms(changed, sources_of(maker))}"


def stale(page):
    """Yields a line of text for each stamp of the page whose sources have changed since its commit, or that names no commit."""
    known = {}
    for number, commit, maker in stamps_in(page):
        if (commit, maker) not in known:
            known[commit, maker] = verdict(commit, maker)
        if known[commit, maker]:
            yield f"{page}:{number}: {known[commit, maker]}"


def stale_in_page():
    """Yields a line of text if the figure that the page shows is stale."""
    if said := verdict(shown_commit(), SHOWN[1]):
        yield f"{SHOWN[0]}: {said}"


def main(pages):
    for page in pages:
        if not (ROOT / page).is_file():
            sys.exit(f"check_figures: {page} is not there: the pages of results are {', '.join(PAGES)}")
    if not has_history():
        sys.exit("check_figures: no whole history of commits is here: clone the repository, not a part of it")
    found = [line for page in pages for line in [*unstamped(page), *stale(page)]] + (list(stale_in_page()) if pages is PAGES else [])
    print("\n".join(found) if found else f"every figure on {len(pages)} page{'s' if len(pages) > 1 else ''} is of the code as it is")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:] or PAGES))
