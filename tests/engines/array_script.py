"""The array script for Slurm, as docs/sweeps.md shows it."""

import sys

from support import HERE, SOURCE

sys.path.insert(0, str(SOURCE / "tests/docs"))
import pages  # noqa: E402  after its folder is known


def write_array_script(folder):
    """Writes the page's script into a folder and returns its file."""
    page = SOURCE / "docs/sweeps.md"
    if page.exists():
        (text,) = [block.text for block in pages.read(page.read_text()).blocks if "#SBATCH" in block.text]
    else:
        text = (HERE / "array.sh").read_text()
    script = folder / "array.sh"
    script.write_text(text)
    return script
