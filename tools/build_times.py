"""The CPU-seconds of a build, per target, from the file that tools/timed_compile wrote: build_times.py BUILD_FOLDER.
CPU-seconds do not count the waiting for a core; on a machine that is busy otherwise they still grow by a half."""

import collections
import pathlib
import re
import sys

if len(sys.argv) != 2:
    sys.exit(__doc__)
seconds = {}
for line in (pathlib.Path(sys.argv[1]) / "build_times.txt").read_text().splitlines():
    used, made = line.split(" ", 1)
    seconds[made] = float(used)  # the last time counts
targets = collections.defaultdict(list)
for made, used in seconds.items():
    targets[re.search(r"([^/]+)\.dir/", made).group(1)].append((used, made.rpartition("/")[2].removesuffix(".o")))
rows = sorted(((sum(used for used, _ in units), name, len(units), *max(units)) for name, units in targets.items()), reverse=True)
print("| target | units | CPU-seconds | the longest |\n|---|---|---|---|")
for total, name, units, longest, which in rows:
    print(f"| {name} | {units} | {total:.0f} | {which} {longest:.0f} |")
print(f"| all | {len(seconds)} | {sum(seconds.values()):.0f} | |")
