"""Real-time priority of the process that calls, where the system allows it."""

import ctypes
import os
import sys

# Above the threads of the kernel's own work at 50 it would delay interrupts.
_FIFO_PRIORITY = 40
_NICE = -15
_MCL_CURRENT = 1
_MCL_FUTURE = 2
_MCL_ONFAULT = 4
_HIGH_PRIORITY_CLASS = 0x80
_THREAD_PRIORITY_TIME_CRITICAL = 15


def ask_for_priority() -> str:
    """Ask the system to run this thread before others, and to keep its memory; a sentence says what was got."""
    if sys.platform == "win32":
        kernel = ctypes.WinDLL("kernel32", use_last_error=True)
        kernel.GetCurrentProcess.restype = kernel.GetCurrentThread.restype = ctypes.c_void_p
        process = kernel.SetPriorityClass(ctypes.c_void_p(kernel.GetCurrentProcess()), _HIGH_PRIORITY_CLASS)
        thread = kernel.SetThreadPriority(ctypes.c_void_p(kernel.GetCurrentThread()), _THREAD_PRIORITY_TIME_CRITICAL)
        if process and thread:
            return "Real-time priority: class high, thread time critical."
        return "Windows allowed no priority above the usual, so that steps may come late."
    message = _fifo() or _nice() or "This system allowed no priority above the usual, so that steps may come late."
    return f"{message} {_keep_memory()}".strip()


def _fifo() -> str:
    if sys.platform != "linux":
        return ""
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(_FIFO_PRIORITY))
    except OSError:
        return ""
    return f"Real-time priority: SCHED_FIFO {_FIFO_PRIORITY}."


def _nice() -> str:
    if sys.platform == "win32":
        return ""
    try:
        os.setpriority(os.PRIO_PROCESS, 0, _NICE)
    except OSError:
        return ""
    return f"No real-time priority was allowed; nice {_NICE} instead."


def _keep_memory() -> str:
    """Locks what is touched, so that nothing of it is swapped out; only where no limit could refuse memory later."""
    if sys.platform != "linux":
        return ""
    import resource

    unlimited = resource.getrlimit(resource.RLIMIT_MEMLOCK)[0] == resource.RLIM_INFINITY
    if not unlimited and os.geteuid() != 0:
        return ""
    locked = ctypes.CDLL(None).mlockall(_MCL_CURRENT | _MCL_FUTURE | _MCL_ONFAULT) == 0
    return "Its memory is locked." if locked else ""
