"""Drives the simulated bus with the maker's own library for Python (feetech-servo-sdk), which shares no code with it.

    peer.py PORT SERVOS        prints `ok`, or what differs
"""
import sys
import time

from scservo_sdk import COMM_SUCCESS, GroupSyncRead, GroupSyncWrite, PacketHandler, PortHandler

MODEL, TORQUE, ACCELERATION, GOAL, STATE, POSITION = 3, 40, 41, 42, 40, 56
STATE_BYTES = 31


def main():
    path, ids = sys.argv[1], range(1, 1 + int(sys.argv[2]))
    port, packets = PortHandler(path), PacketHandler(0)
    # The library compares its time limit with a clock that a busy machine exceeds.
    port.setPacketTimeout = lambda length: port.setPacketTimeoutMillis(500)
    assert port.openPort() and port.setBaudRate(1_000_000)
    for one in ids:
        model, result, error = packets.ping(port, one)
        assert (model, result, error) == (777, COMM_SUCCESS, 0), (one, model, result, error)
        result, error = packets.write1ByteTxRx(port, one, ACCELERATION, 50)
        assert (result, error) == (COMM_SUCCESS, 0), (one, result, error)
        packets.write1ByteTxRx(port, one, TORQUE, 1)
    wanted = {one: 2400 + 20 * one for one in ids}
    writer = GroupSyncWrite(port, packets, GOAL, 2)
    for one, goal in wanted.items():
        assert writer.addParam(one, [goal & 0xFF, goal >> 8])
    assert writer.txPacket() == COMM_SUCCESS
    reader = GroupSyncRead(port, packets, STATE, STATE_BYTES)
    for one in ids:
        assert reader.addParam(one)
    until, found = time.monotonic() + 10, {}
    while found != wanted and time.monotonic() < until:
        assert reader.txRxPacket() == COMM_SUCCESS
        found = {one: reader.getData(one, POSITION, 2) for one in ids}
        assert all(reader.getData(one, GOAL, 2) == goal for one, goal in wanted.items())
    assert found == wanted, f"expected {wanted}, found {found}"
    port.closePort()
    print("ok")


main()
