"""Says which forces a recording of `ist run` has, and fails where it has none: forces.py RECORDING.jsonl"""

import json
import sys

header, *ticks = map(json.loads, open(sys.argv[1]))
ticks = [tick for tick in ticks if "wrench" in tick]
forces = [sum(x * x for x in tick["wrench"][:3]) ** 0.5 for tick in ticks]
faults = sum(tick["fault"] for tick in ticks)
print(f"{header['bodies'][0]['name']} and {header['bodies'][1]['name']}: {len(ticks)} ticks, {faults} faults, at first {forces[0]:.2f} N, "
      f"at most {max(forces):.2f} N")
if faults or forces[0] > 0.01 or not 0.1 < max(forces) < 100:
    sys.exit("that is no press")
