"""A simulated vehicle whose services are started, killed and started again one by one, with a recorder."""
import os
import shlex
import shutil
import signal
import subprocess
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))


class Vehicle:
    """`start` starts everything, the simulator last; leaving the context ends everything. Recordings lie in `recordings`."""

    keep = None  # a folder that gets the recordings of what did not hold

    def __init__(self, build, domain, scenario="survey", speed=1.0, standby=False, environment=None):
        self.bin = os.path.join(build, "bin")
        self.folder = tempfile.TemporaryDirectory(prefix="fathom-black-box-")
        self.recordings = os.path.join(self.folder.name, "recordings")
        self.environment = dict(os.environ, FATHOM_DDS_DIR=os.path.join(ROOT, "deploy/dds"),
                                FATHOM_SCENARIO_DIR=os.path.join(ROOT, "deploy/config/scenarios"))
        self.service_environment = environment or {}
        self.running = {}
        words = [os.path.join(self.bin, "fathom-demo"), "--commands", self.folder.name, "--no-console", "--scenario", scenario,
                 "--speed", str(speed), "--domain", str(domain), "--recordings", self.recordings]
        subprocess.run(words + (["--standby"] if standby else []), env=self.environment, check=True)
        self.commands = {}
        with open(os.path.join(self.folder.name, "commands.txt"), encoding="utf-8") as text:
            for line in text:
                name, command = line.rstrip("\n").split("\t")
                self.commands[name] = shlex.split(command)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop()
        self.folder.cleanup()

    def keep_recordings(self, name):
        """Copies them, with what the services said, for a closer look."""
        if self.keep:
            shutil.copytree(self.folder.name, os.path.join(self.keep, name.replace(" ", "_")), dirs_exist_ok=True,
                            ignore=lambda folder, names: [one for one in names if not one.endswith((".mcap", ".log"))
                                                          and not os.path.isdir(os.path.join(folder, one))])

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def start(self, *names, sets=(), environment=None, wait_s=2.0, out=None):
        """These services, or all of them; `sets`: further overrides; `out`: where they write, instead of their logs."""
        chosen = names or [name for name in self.commands if name != "simulator"]
        for name in chosen:
            words = list(self.commands[name])
            for one in sets:
                words += ["--set", one]
            with open(self.path(name + ".log"), "ab") as log:
                self.running[name] = subprocess.Popen(words, stdout=out or log, stderr=out or log, stdin=subprocess.DEVNULL, env=dict(
                    self.environment, **self.service_environment, **(environment or {})))
        if not names:
            time.sleep(wait_s)
            self.start("simulator", wait_s=0.0, out=out)

    def kill(self, name, how=signal.SIGKILL):
        process = self.running.pop(name)
        process.send_signal(how)
        return process.wait(timeout=30)

    def stop(self):
        """Sensors first, the recorder last, so that it hears what all the others say."""
        ended = [name for name, process in self.running.items() if process.poll() is not None]
        order = sorted(self.running, key=lambda name: (name == "recorder", name != "simulator"))
        for last in (False, True):
            names = [name for name in order if (name == "recorder") == last]
            for name in names:
                self.running[name].terminate()
            for name in names:
                try:
                    self.running[name].wait(timeout=30)
                except subprocess.TimeoutExpired:
                    self.running[name].kill()
            if not last:
                time.sleep(0.5)
        self.running = {}
        if ended:
            raise RuntimeError("\n".join(f"{name} ended by itself:\n{self.log(name)[-2000:]}" for name in ended))

    def files(self):
        """The recordings so far, the oldest first."""
        if not os.path.isdir(self.recordings):
            return []
        return [os.path.join(self.recordings, name) for name in sorted(os.listdir(self.recordings)) if name.endswith(".mcap")]

    def fathom(self, *words):
        """Exit code and output of the command line tool."""
        done = subprocess.run([os.path.join(self.bin, "fathom"), *words], env=self.environment, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        return done.returncode, done.stdout

    def log(self, name):
        with open(self.path(name + ".log"), encoding="utf-8", errors="replace") as text:
            return text.read()


def wait_until(condition, seconds):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():
            return True
        time.sleep(0.05)
    return False
