"""Prints what the ROS 2 node costs: processor and memory without and with a peer, and the delay of joint states."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

SECONDS = 10.0
DOMAIN = "99"
HERE = pathlib.Path(__file__).parent


def main():
    whichone = sys.argv[1]
    with tempfile.TemporaryDirectory(prefix="wo") as home:
        environment = os.environ | {"WHICHONE_HOME": home, "WHICHONE_GROUP": "cost"}

        def call(*words):
            return subprocess.run([whichone, *words], env=environment, check=True, stdout=subprocess.PIPE).stdout

        def node():
            services = json.loads(call("status", "--json"))["services"]
            return next(service for service in services if service["name"] == "ros2")

        def over(seconds):
            before = node()["cpu_s"]
            time.sleep(seconds)
            after = node()
            return 100 * (after["cpu_s"] - before) / seconds, after["rss_kib"] / 1024

        config = str(HERE.parent.parent / "config")
        settings = ["group.services.ros2.after=['speech']", "ros2.services=cyclone", f"ros2.domain_id={DOMAIN}"]
        sets = [word for setting in settings for word in ("--set", setting)]
        call("up", "--detach", "--wait", "ready", "--config", config, "--profile", "ci", *sets)
        try:
            time.sleep(2)
            alone = over(SECONDS)
            script = [sys.executable, str(HERE / "cyclone.py"), DOMAIN]
            peer = subprocess.Popen(script, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

            def tell(command):
                print(command, file=peer.stdin, flush=True)
                return json.loads(peer.stdout.readline())

            while tell("look")["count"]["/joint_states"] < 10:
                time.sleep(0.1)
            tell("forget")
            together = over(SECONDS)
            seen = tell("look")
            peer.kill()
            peer.wait()
        finally:
            call("down")
    print(f"without a peer: {alone[0]:.1f} % of a core, {alone[1]:.1f} MiB")
    print(f"with a peer:    {together[0]:.1f} % of a core, {together[1]:.1f} MiB")
    delay, count = seen["delay_ms"], seen["count"]["/joint_states"]
    print(f"joint states: {count} in {SECONDS:.0f} s, from the measurement to Cyclone DDS in Python", end=" ")
    print(f"p50 {delay['p50']:.2f} ms, p99 {delay['p99']:.2f} ms, max {delay['max']:.2f} ms")


main()
