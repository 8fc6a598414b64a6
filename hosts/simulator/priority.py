"""Requests real-time priority for the calling process."""

import ctypes
import os
import sys

# Above 50, the priority of threads of the kernel, it would delay interrupts.
_FIFO_PRIORITY = 40
_NICE_VALUE = -15
_MCL_CURRENT = 1
_MCL_FUTURE = 2
_MCL_ONFAULT = 4
_HIGH_PRIORITY_CLASS = 0x80
_THREAD_PRIORITY_TIME_CRITICAL = 15


def request_priority() -> str:
    """Request priority for this thread and lock its memory; sentences on what the system has granted."""
    if sys.platform == "win32":
        kernel = ctypes.WinDLL("kernel32", use_last_error=True)
        kernel.GetCurrentProcess.restype = kernel.GetCurrentThread.restype = ctypes.c_void_p
        process = kernel.SetPriorityClass(ctypes.c_void_p(kernel.GetCurrentProcess()), _HIGH_PRIORITY_CLASS)
        thread = kernel.SetThreadPriority(ctypes.c_void_p(kernel.GetCurrentThread()), _THREAD_PRIORITY_TIME_CRITICAL)
        if process and thread:
            return "Real-time priority: class high, thread time critical."
        return "Windows allowed no priority above normal, so steps may be late."
    message = _set_fifo() or _set_nice() or "This system allowed no priority above normal, so steps may be late."
    return f"{message} {_lock_memory()}".strip()


def _set_fifo() -> str:
    if sys.platform != "linux":
        return ""
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(_FIFO_PRIORITY))
    except OSError:
        return ""
    return f"Real-time priority: SCHED_FIFO {_FIFO_PRIORITY}."


def _set_nice() -> str:
    if sys.platform == "win32":
        return ""
    try:
        os.setpriority(os.PRIO_PROCESS, 0, _NICE_VALUE)
    except OSError:
        return ""
    return f"No real-time priority was allowed; nice {_NICE_VALUE} instead."


def _lock_memory() -> str:
    """Lock the used memory against swapping, unless a limit could refuse memory later; a sentence, or empty."""
    if sys.platform != "linux":
        return ""
    import resource

    unlimited = resource.getrlimit(resource.RLIMIT_MEMLOCK)[0] == resource.RLIM_INFINITY
    if not unlimited and os.geteuid() != 0:
        return ""
    locked = ctypes.CDLL(None).mlockall(_MCL_CURRENT | _MCL_FUTURE | _MCL_ONFAULT) == 0
    return "Its memory is locked." if locked else ""
