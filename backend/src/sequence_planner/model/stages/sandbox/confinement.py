"""Sandbox of the `python` stage process: Landlock file access, seccomp system calls and memory limit."""

from __future__ import annotations

import contextlib
import ctypes
import errno
import os
import platform
import resource
import stat
import struct
import sys
import sysconfig
from collections.abc import Iterable
from pathlib import Path

# System calls that a stage has no use for, by their numbers on x86-64 and on 64-bit ARM (none where there is none).
#
# The numbers are those of the kernel's `asm/unistd_64.h` and `asm-generic/unistd.h`, and never change.

FORBIDDEN: dict[str, tuple[int, int | None]] = {
    "socket": (41, 198),
    "socketpair": (53, 199),  # one of it can be sent from to any socket that has a name
    "execve": (59, 221),
    "execveat": (322, 281),
    "fork": (57, None),
    "vfork": (58, None),
    "chmod": (90, None),
    "fchmod": (91, 52),
    "fchmodat": (268, 53),
    "fchmodat2": (452, 452),
    "chown": (92, None),
    "fchown": (93, 55),
    "lchown": (94, None),
    "fchownat": (260, 54),
    "setxattr": (188, 5),
    "lsetxattr": (189, 6),
    "fsetxattr": (190, 7),
    "setxattrat": (463, 463),
    "removexattr": (197, 14),
    "lremovexattr": (198, 15),
    "fremovexattr": (199, 16),
    "removexattrat": (466, 466),
    "utime": (132, None),
    "utimes": (235, None),
    "futimesat": (261, None),
    "utimensat": (280, 88),
    "truncate": (76, 45),
    "kill": (62, 129),
    "tkill": (200, 130),
    "rt_sigqueueinfo": (129, 138),
    "rt_tgsigqueueinfo": (297, 240),
    "pidfd_open": (434, 434),
    "pidfd_send_signal": (424, 424),
    "pidfd_getfd": (438, 438),
    "ptrace": (101, 117),
    "process_vm_readv": (310, 270),
    "process_vm_writev": (311, 271),
    "process_madvise": (440, 440),
    "kcmp": (312, 272),
    "setpriority": (141, 140),
    "sched_setparam": (142, 118),
    "sched_setscheduler": (144, 119),
    "sched_setattr": (314, 274),
    "sched_setaffinity": (203, 122),
    "ioprio_set": (251, 30),
    "migrate_pages": (256, 238),
    "move_pages": (279, 239),
    "shmget": (29, 194),
    "shmat": (30, 196),
    "shmctl": (31, 195),
    "msgget": (68, 186),
    "msgsnd": (69, 189),
    "msgrcv": (70, 188),
    "msgctl": (71, 187),
    "semget": (64, 190),
    "semop": (65, 193),
    "semtimedop": (220, 192),
    "semctl": (66, 191),
    "mq_open": (240, 180),
    "mq_unlink": (241, 181),
    "inotify_init": (253, None),
    "inotify_init1": (294, 26),
    "fanotify_init": (300, 262),
    "add_key": (248, 217),
    "request_key": (249, 218),
    "keyctl": (250, 219),
    "bpf": (321, 280),
    "perf_event_open": (298, 241),
    "userfaultfd": (323, 282),
    "io_uring_setup": (425, 425),
    "io_uring_enter": (426, 426),
    "io_uring_register": (427, 427),
    "mount": (165, 40),
    "umount2": (166, 39),
    "pivot_root": (155, 41),
    "chroot": (161, 51),
    "unshare": (272, 97),
    "setns": (308, 268),
    "fsopen": (430, 430),
    "fsmount": (432, 432),
    "fspick": (433, 433),
    "move_mount": (429, 429),
    "open_tree": (428, 428),
    "mount_setattr": (442, 442),
    "name_to_handle_at": (303, 264),
    "open_by_handle_at": (304, 265),
    "init_module": (175, 105),
    "finit_module": (313, 273),
    "delete_module": (176, 106),
    "kexec_load": (246, 104),
    "kexec_file_load": (320, 294),
    "reboot": (169, 142),
    "swapon": (167, 224),
    "swapoff": (168, 225),
    "sethostname": (170, 161),
    "setdomainname": (171, 162),
    "settimeofday": (164, 170),
    "clock_settime": (227, 112),
    "clock_adjtime": (305, 266),
    "adjtimex": (159, 171),
    "acct": (163, 89),
    "quotactl": (179, 60),
    "quotactl_fd": (443, 443),
    "iopl": (172, None),
    "ioperm": (173, None),
    "syslog": (103, 116),
    "personality": (135, 92),
}
# Looked at more closely.
CLONE = 56, 220
CLONE3 = 435, 435
TGKILL = 234, 131
PRLIMIT64 = 302, 261
FCNTL = 72, 25
OPEN = 2, None
OPENAT = 257, 56
OPENAT2 = 437, 437


# Takes from the process of a stage what a stage does not need, for ever: files, network, other processes, memory.
#
# Landlock lets it read what Python is made of and the station's folder `stages`, and write nothing. A filter of system
# calls (seccomp) leaves it no sockets, no programs to start, and no way to other processes or to the rights of files.
# Both are the kernel's: docs.kernel.org/userspace-api/landlock.html and .../seccomp_filter.html. Nothing outside the
# standard library is imported, as this runs before anything of the station's is loaded.

MOST_MEMORY = 4 * 1024**3  # bytes of addresses
MOST_FILES = 256
MOST_THREADS = 1024  # beyond those that its user has when it begins; the kernel does not count those of root
# Beside what Python looks for modules in: libraries, what NumPy and others look at, and what is nowhere else.
_READ = (
    "/lib",
    "/lib64",
    "/usr/lib",
    "/usr/lib64",
    "/usr/local/lib",
    "/usr/share/zoneinfo",
    "/etc/ld.so.cache",
    "/etc/localtime",
    "/proc/self",
    "/proc/cpuinfo",
    "/proc/meminfo",
    "/sys/devices/system/cpu",
    "/dev/urandom",
    "/dev/zero",
)
_WRITTEN = "/dev/null"
_MACHINES = {"x86_64": (0, 0xC000003E), "aarch64": (1, 0xC00000B7)}  # column of the numbers, AUDIT_ARCH

_CREATE_RULESET, _ADD_RULE, _RESTRICT_SELF = 444, 445, 446
_WRITE_FILE, _READ_FILE, _READ_DIR = 1 << 1, 1 << 2, 1 << 3
_FS_RIGHTS = {1: 13, 2: 14, 3: 15, 4: 15}  # how many rights to files each version knows; later ones 16
_TCP = 0b11  # to bind and to connect
_SCOPES = 0b11  # abstract sockets and signals
_OVER_FILES = 0b110  # the rights of root to files that are somebody else's, as the station reads them too
_CAPABILITIES = 0x20080522  # the version of the call
_PR_SET_NO_NEW_PRIVS, _PR_GET_SECCOMP, _PR_SET_SECCOMP = 38, 21, 22


FILES, CALLS = "files", "the network and other processes"


def missing() -> list[str]:
    """From what of all this system cannot keep a stage."""
    found = [] if _landlock_version() > 0 else [FILES]
    if sys.platform != "linux" or platform.machine() not in _MACHINES or _prctl(_PR_GET_SECCOMP) < 0:
        found.append(CALLS)
    return found


def confine() -> list[str]:
    """Confine this process, which has one thread so far; from what the system cannot keep it."""
    for limit, most in (
        (resource.RLIMIT_AS, MOST_MEMORY),
        (resource.RLIMIT_NOFILE, MOST_FILES),
        (resource.RLIMIT_FSIZE, 0),
        (resource.RLIMIT_CORE, 0),
        (resource.RLIMIT_NPROC, _threads() + MOST_THREADS),
    ):
        hard = resource.getrlimit(limit)[1]
        resource.setrlimit(limit, (most, most) if hard == resource.RLIM_INFINITY else (min(most, hard),) * 2)
    found = missing()
    if sys.platform == "linux":
        _prctl(_PR_SET_NO_NEW_PRIVS, 1)
        _drop_capabilities()
    for part, work in ((FILES, _confine_files), (CALLS, _confine_calls)):
        try:
            if part not in found:
                work()
        except OSError:  # a container may forbid it though the kernel offers it
            found.append(part)
    return found


def _threads() -> int:
    """Count the threads that this user has."""
    found, user = 0, os.getuid()
    with contextlib.suppress(OSError), os.scandir("/proc") as processes:
        for each in processes:
            with contextlib.suppress(OSError):  # it has just ended, or is hidden
                if each.name.isdecimal() and each.stat().st_uid == user:
                    found += Path(each.path, "task").stat().st_nlink - 2
    return found


def _drop_capabilities() -> None:
    """Keep nothing of what makes root more than others, such as the right to raise limits."""
    had = (ctypes.c_uint32 * 6)()
    header = (ctypes.c_uint32 * 2)(_CAPABILITIES, 0)
    if _libc().capget(header, had) == 0:
        kept = (ctypes.c_uint32 * 6)(had[0] & _OVER_FILES, had[1] & _OVER_FILES)
        _libc().capset(header, kept)


def _libc() -> ctypes.CDLL:
    return ctypes.CDLL(None, use_errno=True)


def _prctl(option: int, *arguments: int | ctypes.Structure) -> int:
    given = [ctypes.c_ulong(each) if isinstance(each, int) else ctypes.byref(each) for each in (*arguments, 0, 0, 0, 0)]
    return int(_libc().prctl(ctypes.c_int(option), *given[:4]))


def _called(number: int, *arguments: object) -> int:
    result = int(_libc().syscall(ctypes.c_long(number), *arguments))
    if result < 0:
        raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()))
    return result


def _landlock_version() -> int:
    """Zero where there is no Landlock."""
    try:
        return _called(_CREATE_RULESET, None, ctypes.c_size_t(0), ctypes.c_uint32(1)) if sys.platform == "linux" else 0
    except OSError:
        return 0


def _confine_files() -> None:
    version = _landlock_version()
    rights = (1 << _FS_RIGHTS.get(version, 16)) - 1
    attributes = struct.pack("=QQQ", rights, _TCP, _SCOPES)[: 8 if version < 4 else 16 if version < 6 else 24]
    ruleset = _called(_CREATE_RULESET, attributes, ctypes.c_size_t(len(attributes)), ctypes.c_uint32(0))
    try:
        for path in _readable():
            _allow(ruleset, path, _READ_FILE | _READ_DIR)
        _allow(ruleset, _WRITTEN, _READ_FILE | _WRITE_FILE)
        _called(_RESTRICT_SELF, ctypes.c_int(ruleset), ctypes.c_uint32(0))
    finally:
        os.close(ruleset)


def _readable() -> Iterable[str]:
    libraries = os.environ.get("LD_LIBRARY_PATH", "").split(os.pathsep)
    return dict.fromkeys([*sys.path, *sysconfig.get_paths().values(), *_READ, *libraries])


def _allow(ruleset: int, path: str, rights: int) -> None:
    """Allow it what is at `path`, if there is anything."""
    if not Path(path).is_absolute():
        return
    try:
        place = os.open(path, os.O_PATH | os.O_CLOEXEC)
    except OSError:
        return
    try:
        if not stat.S_ISDIR(os.fstat(place).st_mode):
            rights &= ~_READ_DIR
        rule = struct.pack("=Qi", rights, place)
        _called(_ADD_RULE, ctypes.c_int(ruleset), ctypes.c_int(1), rule, ctypes.c_uint32(0))
    finally:
        os.close(place)


# Instructions of the filter, which is a program of the classic BPF.
_LOAD, _IF_EQUAL, _IF_AT_LEAST, _IF_ANY_BIT, _AND, _RETURN = 0x20, 0x15, 0x35, 0x45, 0x54, 0x06
_NUMBER, _ARCHITECTURE, _FIRST, _SECOND, _THIRD = 0, 4, 16, 24, 32  # where in `struct seccomp_data`
_ALLOW, _KILL, _ERROR = 0x7FFF0000, 0x80000000, 0x00050000
_CLONE_THREAD = 0x00010000
_OTHER_NUMBERS = 0x40000000  # those of x32
# Of `fcntl`: who gets a signal and which one, where Landlock knows no signals, and what makes others wait for a file.
_OF_SIGNALS = (8, 10, 15, 1024, 1026)  # F_SETOWN, F_SETSIG, F_SETOWN_EX, F_SETLEASE, F_NOTIFY
# Flags with which an open file is cut and not written to, which Landlock has not always seen.
_CUTS, _ONLY_CUTS = os.O_TRUNC | os.O_ACCMODE, (os.O_TRUNC, os.O_TRUNC | os.O_ACCMODE)


def _confine_calls() -> None:
    column, architecture = _MACHINES[platform.machine()]
    refuse = (_RETURN, 0, 0, _ERROR | errno.EPERM)
    program: list[tuple[int, int, int, int]] = [
        (_LOAD, 0, 0, _ARCHITECTURE),
        (_IF_EQUAL, 1, 0, architecture),
        (_RETURN, 0, 0, _KILL),
        (_LOAD, 0, 0, _NUMBER),
        (_IF_AT_LEAST, 0, 1, _OTHER_NUMBERS),
        refuse,
    ]
    for numbers in FORBIDDEN.values():
        if (number := numbers[column]) is not None:
            program += [(_IF_EQUAL, 0, 1, number), refuse]
    # Without them the C library makes threads and opens files by older calls, whose flags can be looked at.
    for newer in (CLONE3, OPENAT2):
        program += [(_IF_EQUAL, 0, 1, newer[column]), (_RETURN, 0, 0, _ERROR | errno.ENOSYS)]
    program += [
        (_IF_EQUAL, 0, 4, CLONE[column]),
        (_LOAD, 0, 0, _FIRST),
        (_IF_ANY_BIT, 0, 1, _CLONE_THREAD),
        (_RETURN, 0, 0, _ALLOW),
        refuse,
    ]
    for number, own in ((TGKILL[column], (os.getpid(),)), (PRLIMIT64[column], (0, os.getpid()))):
        program += [
            (_IF_EQUAL, 0, 3 + len(own), number),
            (_LOAD, 0, 0, _FIRST),
            *((_IF_EQUAL, len(own) - at, 0, each) for at, each in enumerate(own)),
            refuse,
            (_RETURN, 0, 0, _ALLOW),
        ]
    for numbers, argument, bits, refused in (
        (FCNTL, _SECOND, 0xFFFFFFFF, _OF_SIGNALS),
        (OPEN, _SECOND, _CUTS, _ONLY_CUTS),
        (OPENAT, _THIRD, _CUTS, _ONLY_CUTS),
    ):
        if (number := numbers[column]) is not None:
            program += [
                (_IF_EQUAL, 0, 4 + len(refused), number),
                (_LOAD, 0, 0, argument),
                (_AND, 0, 0, bits),
                *((_IF_EQUAL, len(refused) - at, 0, each) for at, each in enumerate(refused)),
                (_RETURN, 0, 0, _ALLOW),
                refuse,
            ]
    program.append((_RETURN, 0, 0, _ALLOW))
    written = b"".join(struct.pack("=HBBI", *each) for each in program)
    buffer = ctypes.create_string_buffer(written, len(written))

    class Program(ctypes.Structure):
        _fields_ = [("length", ctypes.c_ushort), ("filter", ctypes.c_void_p)]

    whole = Program(len(program), ctypes.addressof(buffer))
    if _prctl(_PR_SET_SECCOMP, 2, whole) != 0:
        raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()))
