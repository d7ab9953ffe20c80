"""Every way in which a program with a live client may end: with its own exit code, soon, and without a word too many."""
import re
import signal
import subprocess
import sys
import textwrap
import unittest

from vehicle import DOMAIN, PATIENCE_S, SOURCE, WITH_NUMPY, WithVehicle

BEGIN = "" if WITH_NUMPY else "import sys; sys.modules['numpy'] = None\n"
HEARING = f"""
import atexit, gc, os, signal, sys, threading, time
import fathom
navigation = fathom.Client(domain={DOMAIN}, vehicle="auv")
heard = threading.Event()
navigation.on_nav_state(lambda state: heard.set())
assert heard.wait({PATIENCE_S})
"""


def run(program, hearing=True):
    """(exit code, output, what it complained of)"""
    text = BEGIN + (HEARING if hearing else "") + textwrap.dedent(program)
    done = subprocess.run([sys.executable, "-X", "faulthandler", "-c", text], capture_output=True, text=True, check=False,
                          timeout=PATIENCE_S)
    return done.returncode, done.stdout, done.stderr


class EndingsTest(WithVehicle):
    def test_by_running_out_of_lines(self):
        self.assertEqual(run("print('end')"), (0, "end\n", ""))

    def test_by_its_exit_code(self):
        self.assertEqual(run("sys.exit(3)"), (3, "", ""))

    def test_by_an_exception(self):
        code, _, err = run("navigation.health().nothing")
        self.assertEqual(code, 1)
        self.assertIn("AttributeError", err)

    def test_while_a_handler_runs(self):
        self.assertEqual(run("""
            entered = threading.Event()
            def handler(state):
                entered.set()
                time.sleep(0.5)
                print("done", flush=True)
            navigation.on_nav_state(handler)
            entered.wait()
            """), (0, "done\n", ""))

    def test_while_a_handler_never_returns(self):
        self.assertEqual(run("""
            entered = threading.Event()
            def handler(state):
                entered.set()
                while True: time.sleep(0.01)
            navigation.on_nav_state(handler)
            entered.wait()
            """), (0, "", ""))

    def test_while_threads_wait_and_ask(self):
        self.assertEqual(run("""
            silent = fathom.Client(domain=%d, vehicle="another")
            def ask():
                while True:
                    navigation.wait_next(1.0)
                    navigation.latest().velocity_N_m_s
                    navigation.health()
            for one in [ask, ask, lambda: silent.wait_next(1e9)]:
                threading.Thread(target=one, daemon=True).start()
            time.sleep(0.3)
            """ % DOMAIN), (0, "", ""))

    def test_with_a_handler_that_refers_to_the_client(self):
        self.assertEqual(run("""
            navigation.on_nav_state(lambda state, n=navigation: n.health())
            navigation.handler = lambda: navigation
            del navigation
            gc.collect()
            time.sleep(0.2)
            """), (0, "", ""))

    def test_closed_by_what_runs_at_exit_as_well(self):
        self.assertEqual(run("""
            atexit.register(lambda: (navigation.close(), print("closed")))
            """), (0, "closed\n", ""))

    def test_used_by_what_runs_at_exit_after_the_client_has_gone(self):
        code, out, err = run("""
            import atexit
            def last():
                try: navigation.wait_next(1.0)
                except RuntimeError as error: print(error)
            atexit.register(last)
            import fathom
            navigation = fathom.Client(domain=%d)
            """ % DOMAIN, hearing=False)
        self.assertEqual((code, out, err), (0, "Client: is closed\n", ""))

    def test_by_ctrl_c_while_it_waits(self):
        program = subprocess.Popen([sys.executable, "-c", BEGIN + HEARING + textwrap.dedent("""
            silent = fathom.Client(domain=%d, vehicle="another")
            try:
                print("waiting", flush=True)
                silent.wait_next(1e9)
            except KeyboardInterrupt: print("interrupted"); sys.exit(5)
            """ % DOMAIN)], stdout=subprocess.PIPE, text=True)
        self.assertEqual(program.stdout.readline(), "waiting\n")
        program.send_signal(signal.SIGINT)
        out, _ = program.communicate(timeout=PATIENCE_S)
        self.assertEqual((program.returncode, out), (5, "interrupted\n"))

    def test_with_processes_that_were_forked(self):
        code, out, err = run(f"""
            import multiprocessing, warnings
            warnings.simplefilter("ignore", DeprecationWarning)  # Python 3.12 on advises against what is done here
            def work(queue):
                try: navigation.health()
                except RuntimeError as error: queue.put(str(error))
                navigation.close()
            forking = multiprocessing.get_context("fork")
            queue = forking.Queue()
            child = forking.Process(target=work, args=(queue,))
            child.start()
            print(queue.get(timeout={PATIENCE_S}))
            child.join({PATIENCE_S})
            assert child.exitcode == 0, child.exitcode
            child = os.fork()
            if child == 0:
                del navigation
                gc.collect()
                os._exit(0)
            assert os.waitpid(child, 0)[1] == 0
            assert navigation.wait_next({PATIENCE_S}) is not None
            """)
        self.assertEqual((code, err), (0, ""))
        self.assertEqual(out, "Client: was made by another process, expected one of this process\n")

    def test_the_ten_lines_of_the_documentation(self):
        with open(f"{SOURCE}/common/python/README.md", encoding="utf-8") as file:
            lines = re.search(r"```python\n(.*?)```", file.read(), re.S).group(1)
        self.assertLessEqual(len(lines.splitlines()), 10)
        self.assertEqual(lines.count("domain=0"), 1)
        program = subprocess.Popen([sys.executable, "-u", "-c", BEGIN + lines.replace("domain=0", f"domain={DOMAIN}")],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        # 0.300 mrad to the north and 0.321 to the east is on a course of 47 degrees; the heading is 30.
        self.assertEqual(program.stdout.readline(), "turn +17 deg\n")
        route = self.vehicle.routes.get(timeout=PATIENCE_S)
        self.assertEqual(route[:7], ["route", "auv", "guidance", "0", "0", "1", "A"])
        self.vehicle.say("states off")
        try:
            _, err = program.communicate(timeout=PATIENCE_S)
            self.assertEqual((program.returncode, err), (0, ""))
        finally:
            self.vehicle.say("states on")


if __name__ == "__main__":
    unittest.main()
