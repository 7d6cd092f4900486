"""The steps of the ablation: what each adds or leaves out, its spheres, and its runs."""

SIZES = ("0.2", "0.8")
POSES = ("0.0", "-1.5")
PLACE = {"0.0": "full occlusion (dz = 0)", "-1.5": "near contact (dz = -1.5)"}
POLICIES = ("simple", "table", "tight", "slab")

# What a step of the ladder adds; one that is not here adds an instruction set.
ADDED = {
    "pointers_simple": "published, its nodes as pointers: circumspheres",
    "pointers_table": "+ lookup table",
    "linear_table": "+ linear layout",
    "batches": "+ breadth-first batches",
    "tight": "+ tight balls",
    "slab": "+ slabs",
    "second_worker": "+ second worker",
}
INSTRUCTIONS = {"ssse3": "SSSE3", "sse4": "SSE4", "avx2": "AVX2", "avx3": "AVX-512"}
LEFT_OUT = {
    "second_worker": "second worker",
    "simd": "SIMD",
    "simd_and_worker": "SIMD and second worker",
    "slab": "slabs",
    "tight": "tight balls, slabs (so: table)",
    "table": "tight balls, slabs, table (so: circumspheres)",
    "batches": "batches, SIMD, second worker",
    "layout": "linear layout, batches, SIMD, second worker",
}


class Variants:
    """The variants of one kind and voxel size, in the order measured: runs by name and dz."""

    def __init__(self, results, kind, size):
        self.runs = {}
        for run in results.runs("ablation_bench", "ablation", kind):
            _, _, step, at, dz = run.parts
            if at == size:
                self.runs.setdefault(step if kind == "same" else step.split("-", 1)[1], {})[dz] = run

    def names(self):
        return list(self.runs)

    def of(self, name, counter, dz):
        return self.runs[name][dz][counter]

    def times(self, slow, fast, dz):
        """How many times faster `fast` is than `slow`."""
        return self.of(slow, "p50_us", dz) / self.of(fast, "p50_us", dz)

    def samples(self):
        """Of how many queries a median is, as a text."""
        counts = [int(run["n"]) for poses in self.runs.values() for run in poses.values()]
        return f"{min(counts):,} to {max(counts):,}"


def added(name):
    return ADDED[name] if name in ADDED else f"+ SIMD: {INSTRUCTIONS.get(name, name)}"


def policy_of(step):
    """The spheres of a step of the ladder."""
    return {"pointers_simple": "simple", "linear_simple": "simple", "pointers_table": "table", "linear_table": "table", "batches": "table",
            "tight": "tight"}.get(step, "slab")


def main_line(variants):
    """The steps of which each adds to the one before it; linear_simple stands beside them."""
    return [name for name in variants.names() if name != "linear_simple"]
