"""Losses in words: what lost, in bold, with its reason where one is known."""

NOT_EXPLAINED = "not explained"


def by_reason(lost):
    """What lost, in one bold text: pairs of a text and its reason, or None where none is known, grouped by reason."""
    groups = {}
    for text, reason in lost:
        groups.setdefault(reason or NOT_EXPLAINED, []).append(text)
    return "; ".join(f"**{', '.join(texts)}** ({reason})" for reason, texts in groups.items())


def bold_if(text, lost):
    return f"**{text}**" if lost else text
