"""The bus: one line from end to end, 120 ohms at both ends, short stubs, a common ground."""

from kit import Picture

LEFT, RIGHT = 92, 828
WIRES = {"CAN_H": 196, "CAN_L": 244, "GND": 288}
STUBS = {"CAN_H": -28, "CAN_L": 0, "GND": 28}  # beside a node's middle
NODES = [(208, "arm", "0.2"), (376, "sensors", "0.3"), (544, "lights", "0.4"), (712, "PC", "0.10")]


def picture():
    p = Picture(880, 420, "The bus",
                "Four nodes hang on one line of three wires, CAN_H, CAN_L and GND, by stubs below 0.3 m. "
                "A resistor of 120 ohms joins CAN_H and CAN_L at each of the two ends of the line.")
    for x, name, address in NODES:
        p.titled(x - 60, 36, 120, 68, name, [address])
        for wire, offset in STUBS.items():
            p.line([(x + offset, 104), (x + offset, WIRES[wire])], "hot" if wire != "GND" else "")
    for wire, y in WIRES.items():
        p.text(LEFT - 12, y, wire, "small mono", "end")
        p.line([(LEFT, y), (RIGHT, y)], "hot" if wire != "GND" else "", halo=4)
        for x, _, _ in NODES:
            p.dot(x + STUBS[wire], y, "solid" if wire != "GND" else "dark")
    for x, label, anchor in ((LEFT, 16, "start"), (RIGHT, -16, "end")):
        p.resistor(x, WIRES["CAN_H"], 48, upright=True)
        p.text(x + label, 220, "120 Ω", "bold", anchor)
    p.measure((256, 108), (256, 192))
    p.lines(268, 136, ["a stub:", "below", "0.3 m"], "small muted", step=16)
    p.measure((LEFT, 328), (RIGHT, 328))
    p.lines(440, 356, [
        "40 m at 1 Mbit/s  ·  100 m at 500 kbit/s  ·  250 m at 250 kbit/s  ·  500 m at 125 kbit/s",
        ("Power off, a multimeter shows 60 Ω between CAN_H and CAN_L: two terminators, and no third.", "muted")],
            anchor="middle", step=28)
    return p
