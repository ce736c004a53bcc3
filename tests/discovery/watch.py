"""Robots in the local network, as another implementation of multicast DNS sees them (python-zeroconf).

    watch.py [NAME]

Prints one JSON object for each robot that appears, changes or leaves. With NAME it first registers a robot of that name
itself. Ends with its standard input.
"""

import json
import sys

from zeroconf import IPVersion, ServiceBrowser, ServiceInfo, ServiceListener, Zeroconf

SERVICE = "_whichone._tcp.local."


class Printer(ServiceListener):
    """Prints what it is told."""

    def add_service(self, zc: Zeroconf, type_: str, name: str) -> None:
        """Print a robot that has appeared."""
        self._print("added", zc, type_, name)

    def update_service(self, zc: Zeroconf, type_: str, name: str) -> None:
        """Print a robot whose records have changed."""
        self._print("updated", zc, type_, name)

    def remove_service(self, zc: Zeroconf, type_: str, name: str) -> None:
        """Print a robot that has left."""
        print(json.dumps({"event": "removed", "name": name}), flush=True)

    def _print(self, event: str, zc: Zeroconf, type_: str, name: str) -> None:
        info = zc.get_service_info(type_, name, timeout=3000)
        found = {"event": event, "name": name}
        if info is not None:
            text = {key.decode(): (value or b"").decode() for key, value in info.properties.items()}
            found |= {
                "host": info.server,
                "port": info.port,
                "addresses": sorted(info.parsed_addresses(IPVersion.All)),
                "text": text,
            }
        print(json.dumps(found), flush=True)


def main() -> None:
    """Watch until standard input ends."""
    with Zeroconf(ip_version=IPVersion.V4Only) as network:
        for name in sys.argv[1:]:
            taken = ServiceInfo(
                SERVICE,
                f"{name}.{SERVICE}",
                addresses=[bytes([10, 77, 0, 1])],
                port=1,
                properties={"id": "another"},
                server="another.local.",
            )
            network.register_service(taken)
        ServiceBrowser(network, SERVICE, Printer())
        sys.stdin.read()


main()
