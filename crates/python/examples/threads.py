"""Two threads, each with its own stack: the results are those of one after the other.

All computation runs without Python's global lock. On a free-threaded Python no lock is left, and importing the
package does not bring it back.
"""

import sys
import sysconfig
from threading import Thread

import numpy as np

from barrelstack import Run, Scenario

FRICTION = (0.25, 0.35)

free = bool(sysconfig.get_config_var("Py_GIL_DISABLED"))
locked = bool(getattr(sys, "_is_gil_enabled", lambda: True)())
assert locked != free, "the package, or numpy, has brought the global lock back"


def stack(friction: float) -> Scenario:
    return Scenario(
        {
            "stack": {"levels": 3, "columns": 2},
            "interface": {"rack-ground": {"friction": {"coefficient": friction}}},
            "motion": {"sine": {"amplitude": "10 cm", "period": "0.8 s", "cycles": 3}},
        }
    )


def run(friction: float) -> None:
    done[friction] = stack(friction).run(variants=0)


done: dict[float, Run] = {}
threads = [Thread(target=run, args=(friction,)) for friction in FRICTION]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
for friction in FRICTION:
    alone = stack(friction).run(variants=0)
    names = alone.histories.keys()
    assert all(np.array_equal(done[friction].histories[name], alone.histories[name]) for name in names)
    print(f"friction {friction}: {done[friction].headline}")
print(f"two threads, {'without' if free else 'with'} the global lock: the same bits as one after the other")
