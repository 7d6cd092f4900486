"""Losses: when a factor is one, how it is written, and why a part loses where it does."""

from report.text import number

NOISE = 0.03  # factors nearer to 1 are no gain and no loss
NOT_EXPLAINED = "not explained"
# By the step that adds the part: what it does that its absence does not, in the code. What is not here is not explained.
WHY = {
    "pointers_table": "a sphere by the table takes longer to make than a circumsphere",
    "linear_table": "a visit computes the child's centre and place, which a node with pointers stores",
    "linear_simple": "a visit computes the child's centre and place, which a node with pointers stores",
    "batches": "a batch writes its pairs to memory and reads them again, and without vectors nothing is gained by that",
    "tight": "a ball is read from memory and unpacked, instead of made",
    "slab": "a test reads and compares two slabs beside the balls",
}


def is_loss(value):
    return value < 1 - NOISE


def factor(value):
    """A factor, in bold where it is a loss."""
    text = number(value, 3) if value >= 10 else f"{value:.2f}"
    return f"**{text}**" if is_loss(value) else text


def listing(words):
    words = list(words)
    return words[0] if len(words) == 1 else ", ".join(words[:-1]) + " and " + words[-1]


def why(part, tests, times):
    """Why a part loses with which a query makes `tests` times the tests, and is `times` times as fast: what its tests do."""
    change = "as many tests" if abs(tests - 1) < 0.005 else f"{100 * abs(1 - tests):.0f} % {'fewer' if tests < 1 else 'more'} tests"
    return f"{change}, at {1 / times / tests:.2f} times the time of a test: {WHY.get(part, NOT_EXPLAINED)}"


def by_reason(lost):
    """What lost, in one bold text: pairs of a text and its reason, or None where none is known, grouped by reason."""
    groups = {}
    for text, reason in lost:
        groups.setdefault(reason or NOT_EXPLAINED, []).append(text)
    return "; ".join(f"**{', '.join(texts)}** ({reason})" for reason, texts in groups.items())


def bold_if(text, lost):
    return f"**{text}**" if lost else text
