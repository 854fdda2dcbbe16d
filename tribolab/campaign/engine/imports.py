"""Imported first by a nursery: no garbage is looked for until its copies begin to work.

All that is imported stays. Its hundred thousands of small objects would be gone through again and
again, which takes as long as a third of the imports; the copies look for garbage (`begin_worker`).
"""

import gc

gc.disable()
