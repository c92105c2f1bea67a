"""What a command costs: time, processor time, memory and disk.

    python3 make/million.py FOLDER RUNS COMMAND ...

Runs COMMAND, which writes RUNS runs into FOLDER, and prints what it took. Memory is the largest resident set of the command, as
the system counts it for a child that has ended.
"""

import os
import resource
import subprocess
import sys
import time

folder, runs, *command = sys.argv[1:]
began = time.monotonic()
code = subprocess.run(command, stdout=subprocess.DEVNULL).returncode
seconds = time.monotonic() - began
if code != 0:
    sys.exit(code)
used = resource.getrusage(resource.RUSAGE_CHILDREN)
sizes = [os.path.getsize(os.path.join(at, name)) for at, _, names in os.walk(folder) for name in names]
processor = used.ru_utime + used.ru_stime
# Linux counts the resident set in KiB.
print(f"time {seconds:.0f} s, processor time {processor:.0f} s, memory {used.ru_maxrss / 1024:.0f} MiB, ", end="")
print(f"disk {sum(sizes) / 2**20:.0f} MiB, {sum(sizes) / int(runs):.0f} bytes a run")
