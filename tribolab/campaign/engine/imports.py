"""First import of a nursery: turn off garbage collection until worker processes start.

Imported modules stay in memory. Scanning their hundreds of thousands of objects repeatedly takes a
third of the import time; the copies enable collection again (`begin_worker`).
"""

import gc

gc.disable()
