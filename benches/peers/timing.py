"""How long something takes. `run(steps)` does so many steps and returns the seconds these took."""

import time


def clock():
    """Processor time: what others run in the meantime does not count."""
    return time.thread_time()


def speed(run, seconds):
    """Steps in a second of processor time and in one of the clock's, over about so many seconds of the former."""
    steps = 1
    taken = run(steps)
    done, elapsed, began = 0, 0.0, time.perf_counter()
    while elapsed < seconds:
        # Batches of about 50 ms, so that the clock is read rarely.
        steps = max(1, min(5000, 4 * steps, int(0.05 * steps / max(taken, 1e-9))))
        taken = run(steps)
        done, elapsed = done + steps, elapsed + taken
    return done / elapsed, done / (time.perf_counter() - began)
