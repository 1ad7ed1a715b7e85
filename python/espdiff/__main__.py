"""`python -m espdiff`: the command line, in this Python."""

import os
import sys


def _start_again_with_settings():
    """As the program does: OpenMP's threads spin while they wait, and the kernel hands out small pages, unless the
    environment says otherwise at the start."""
    before = dict(os.environ)
    if "GOMP_SPINCOUNT" not in os.environ:
        os.environ.setdefault("OMP_WAIT_POLICY", "passive")
    os.environ.setdefault("GLIBC_TUNABLES", "glibc.malloc.hugetlb=1")
    if os.environ == before:
        return
    words = getattr(sys, "orig_argv", None) or [sys.executable, "-m", "espdiff", *sys.argv[1:]]
    os.execv(sys.executable, [sys.executable, *words[1:]])


def _reader():
    """MDAnalysis' name and version; empty where it is not installed."""
    from importlib import metadata

    try:
        return "MDAnalysis " + metadata.version("MDAnalysis")
    except metadata.PackageNotFoundError:
        return ""


def main(arguments=None):
    """Runs `espdiff ARGUMENTS...` in this process (sys.argv without any); returns the exit status."""
    from ._core import command_line

    for stream in (sys.stdout, sys.stderr):
        if stream is not None:
            stream.flush()
    words = [os.fspath(word) for word in (sys.argv[1:] if arguments is None else arguments)]
    try:
        return command_line(words, _reader())
    except KeyboardInterrupt:  # before the engine has taken over Ctrl-C
        print("espdiff: cancelled; nothing was written", file=sys.stderr)
        return 1


def start():
    """The console script `espdiff`."""
    _start_again_with_settings()
    sys.exit(main())


if __name__ == "__main__":
    start()
