"""python-can as a peer.

python_peer.py send INTERFACE FRAME...      sends frames written as cansend takes them
python_peer.py receive INTERFACE COUNT      prints COUNT frames in the same form
"""

import sys

import can


def parse(text):
    identifier, data = text.split("#")
    remote = data.startswith("R")
    return can.Message(
        arbitration_id=int(identifier, 16),
        is_extended_id=len(identifier) == 8,
        is_remote_frame=remote,
        dlc=int(data[1:] or 0) if remote else len(data) // 2,
        data=None if remote else bytes.fromhex(data),
    )


def text(message):
    identifier = f"{message.arbitration_id:0{8 if message.is_extended_id else 3}X}"
    if message.is_remote_frame:
        return f"{identifier}#R{message.dlc or ''}"
    return f"{identifier}#{message.data.hex().upper()}"


def main(action, interface, *rest):
    with can.Bus(interface="socketcan", channel=interface) as bus:
        if action == "send":
            for one in rest:
                bus.send(parse(one), timeout=10)
        else:
            for _ in range(int(rest[0])):
                message = bus.recv(timeout=20)
                if message is None:
                    sys.exit("python_peer: no more frames came within 20 s")
                print(text(message), flush=True)


main(*sys.argv[1:])
