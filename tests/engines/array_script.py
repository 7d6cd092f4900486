"""The array script for Slurm, as docs/sweeps.md shows it."""

import sys

from support import SOURCE

sys.path.insert(0, str(SOURCE / "tests/docs"))
import pages  # noqa: E402  after its folder is known


def write_array_script(folder):
    """Writes the page's script into a folder and returns its file."""
    page = pages.read((SOURCE / "docs/sweeps.md").read_text())
    (text,) = [block.text for block in page.blocks if "#SBATCH" in block.text]
    script = folder / "array.sh"
    script.write_text(text)
    return script
