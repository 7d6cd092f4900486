from typing import Any, Optional

from . import Follow, Sweep, SweepStatus

def run(
    sweep: Sweep, client: Any, threads: int = 1, retries: int = 3, progress: Optional[Follow] = None
) -> SweepStatus: ...
