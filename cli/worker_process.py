"""The worker beside the service: a child process that is watched, started again when it dies, and stopped."""

import contextlib
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from cli.child_process import die_with_parent

QUICK_DEATH_S = 10.0
GIVE_UP_AFTER = 5
"""This many deaths in a row, each within QUICK_DEATH_S of the start, and the worker is not started again."""
LONGEST_PAUSE_S = 30.0


def worker_command() -> list[str]:
    """Return the command line of a worker: the one that people type, with this Python and without the banner."""
    return [sys.executable, "-m", "celery", "--quiet", "-A", "workers.app", "worker"]


@dataclass
class WorkerProcess:
    """Keeps one worker process running until :meth:`stop`.

    Args:
        command: its command line.
        environment: its environment.
        say: told in a sentence when the worker died, is started again, or is given up.
        pause_s: before it is started again the first time; doubled at each quick death.
        grace_s: how long a stopping worker may take; a little more than its own setting ``shutdown_grace_s``, after
            which it puts its job back into the queue.
    """

    command: list[str]
    environment: Mapping[str, str]
    say: Callable[[str], None]
    pause_s: float = 1.0
    grace_s: float = 10.0
    process: "subprocess.Popen[bytes] | None" = field(default=None, init=False)
    _stopping: threading.Event = field(default_factory=threading.Event, init=False)
    _keeper: threading.Thread | None = field(default=None, init=False)

    def start(self) -> int:
        """Start the worker and a thread that watches it; return the process id."""
        self.process = self._launch()
        self._keeper = threading.Thread(target=self._keep, name="worker-keeper", daemon=True)
        self._keeper.start()
        return self.process.pid

    def stop(self) -> None:
        """Stop the worker: politely, then firmly, then at once. No process of it is left."""
        self._stopping.set()
        if self._keeper is not None:
            self._keeper.join()
        process = self.process
        if process is None:
            return
        # TERM: put the job back and leave; QUIT: leave; KILL: the whole process group
        for request in (signal.SIGTERM, signal.SIGQUIT):
            if process.poll() is None:
                process.send_signal(request)
                try:
                    process.wait(timeout=self.grace_s)
                except subprocess.TimeoutExpired:
                    continue
        self._kill_group(process)
        process.wait()

    def _launch(self) -> "subprocess.Popen[bytes]":
        # its own session: Ctrl-C in the terminal reaches the service alone, which then stops the worker in order
        return subprocess.Popen(
            self.command,
            env=dict(self.environment),
            stdin=subprocess.DEVNULL,
            stdout=sys.stderr.fileno(),
            stderr=sys.stderr.fileno(),
            start_new_session=True,
            preexec_fn=die_with_parent,
        )

    @staticmethod
    def _kill_group(process: "subprocess.Popen[bytes]") -> None:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)

    def _keep(self) -> None:
        quick_deaths = 0
        started_s = time.monotonic()
        while not self._stopping.wait(0.2):
            process = self.process
            if process is None or process.poll() is None:
                continue
            self._kill_group(process)  # children that outlived it
            quick_deaths = quick_deaths + 1 if time.monotonic() - started_s < QUICK_DEATH_S else 1
            if quick_deaths >= GIVE_UP_AFTER:
                self.say(
                    f"the worker died {quick_deaths} times in a row (status {process.returncode}) and is not started "
                    "again; the service goes on, jobs stay queued"
                )
                return
            pause_s = min(self.pause_s * 2.0 ** (quick_deaths - 1), LONGEST_PAUSE_S)
            self.say(f"the worker died (status {process.returncode}); started again in {pause_s:g} s")
            if self._stopping.wait(pause_s):
                return
            started_s = time.monotonic()
            self.process = self._launch()
