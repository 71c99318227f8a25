"""An Uno and the usual blue module, wire by wire. Both are drawn to scale, 6 px a millimetre and 16 px a pin."""

from kit import Picture

PIN = 16
UNO = (88, 88)  # upper left corner; the USB socket is above
MODULE = (588, 152)
DIGITAL = ["SCL", "SDA", "AREF", "GND", "13", "12", "11", "10", "9", "8", None, "7", "6", "5", "4", "3", "2", "1", "0"]
POWER = [None, "IOREF", "RESET", "3.3V", "5V", "GND", "GND", "VIN", None, "A0", "A1", "A2", "A3", "A4", "A5"]
HEADER = ["VCC", "GND", "CS", "SO", "SI", "SCK", "INT"]
# module's pin: Uno's pin, where the wire turns, how it is drawn
WIRES = {"GND": ("GND", 456, ""), "SO": ("12", 476, "hot"), "SI": ("11", 496, "hot"), "CS": ("10", 516, "hot"),
         "SCK": ("13", 436, "hot"), "INT": ("2", 536, "hot dashed")}


def hole(p, x, y):
    p.bar(x - 4, y - 4, 8, 8, "hole", 0)


def uno(p):
    """Draws the board; gives the places of its pins."""
    x, y = UNO
    p.box(x, y, 320, 412, "fill", 12)
    p.bar(x + 200, y - 28, 72, 84, "metal", 4)
    p.text(x + 236, y + 12, "USB", "small on-metal", "middle")
    p.bar(x + 36, y - 12, 56, 76, "metal", 4)
    p.text(x + 64, y + 20, "power", "small on-metal", "middle")
    p.text(x + 156, y + 196, "Arduino Uno", "bold big", "middle")
    places = {}
    for column, names, top, anchor, label in ((x + 304, DIGITAL, y + 92, "end", -14), (x + 16, POWER, y + 148, "start", 14)):
        p.bar(column - 8, top - 8, PIN, PIN * len(names), "dark", 2)
        for row, name in enumerate(names):
            if name is None:
                continue
            used = name in USED and (name, anchor) != ("GND", "start")
            places.setdefault((name, anchor), (column, top + PIN * row))
            hole(p, column, top + PIN * row)
            p.text(column + label, top + PIN * row, name, "small mono" + (" bold accent" if used else " muted"), anchor)
    return places


def module(p):
    x, y = MODULE
    p.box(x, y, 240, 168, "tint", 8)
    places = {}
    p.bar(x + 8, y + 28, PIN, PIN * len(HEADER), "dark", 2)
    for row, name in enumerate(HEADER):
        places[name] = (x + 16, y + 36 + PIN * row)
        hole(p, *places[name])
        p.text(x + 30, places[name][1], name, "small mono bold", "start")
    p.bar(x + 80, y + 16, 52, 36, "metal", 16)
    p.text(x + 106, y + 34, "8.000", "small mono on-metal", "middle")
    p.bar(x + 84, y + 76, 48, 60, "dark", 4)
    p.text(x + 108, y + 98, "MCP", "small on-accent", "middle")
    p.text(x + 108, y + 114, "2515", "small on-accent", "middle")
    p.bar(x + 148, y + 76, 36, 40, "dark", 4)
    p.text(x + 166, y + 96, "TJA", "small on-accent", "middle")
    p.bar(x + 148, y + 136, 36, 20, "metal", 4)
    p.text(x + 166, y + 146, "J1", "small bold on-metal", "middle")
    p.bar(x + 200, y + 48, 40, 72, "metal", 4)
    p.text(x + 220, y + 68, "H", "small bold on-metal", "middle")
    p.text(x + 220, y + 100, "L", "small bold on-metal", "middle")
    return places


USED = {uno_pin for uno_pin, _, _ in WIRES.values()} | {"5V"}


def notes(p):
    x, y = MODULE
    p.line([(x + 104, y + 12), (x + 104, y - 24)], "thin")
    p.lines(x + 104, y - 56, [("crystal 8.000: 8 MHz", "bold"), ("the sketch must say so", "small muted")], anchor="middle")
    p.line([(x + 168, y + 160), (x + 168, y + 192)], "thin")
    p.lines(x + 120, y + 208, [("jumper J1: 120 Ω between H and L", "bold"),
                               ("set on the modules at the two ends of the bus,", "small muted"),
                               ("and on no other", "small muted")], anchor="middle")
    p.lines(x + 120, y + 292, [("SI to 11, SO to 12: not crossed", "bold"),
                               ("INT to 2 may be left out", "small muted")], anchor="middle")
    for wire, row, label in (("CAN_H", 68, -12), ("CAN_L", 100, 14)):
        p.line([(x + 240, y + row), (x + 304, y + row)], "hot")
        p.text(x + 308, y + row + label, wire, "small mono", "end")
    p.text(x + 308, y + 136, "to the bus", "small muted", "end")


def picture():
    p = Picture(960, 540, "An Arduino Uno and an MCP2515 module",
                "VCC of the module goes to 5V of the Uno, GND to GND, CS to 10, SO to 12, SI to 11, SCK to 13, and INT, which "
                "may be left out, to 2. The module's crystal is marked 8.000: 8 MHz. The jumper J1 puts 120 ohms between "
                "CAN_H and CAN_L, and is set at the two ends of the bus only.",
                ".metal{fill:var(--muted)} .on-metal{fill:var(--card)}")
    on_uno, on_module = uno(p), module(p)
    start, end = on_uno["5V", "start"], on_module["VCC"]
    wires = [([start, (UNO[0] - 36, start[1]), (UNO[0] - 36, 36), (MODULE[0] - 28, 36), (MODULE[0] - 28, end[1]), end], "")]
    for name, (uno_pin, turn, style) in WIRES.items():
        (x1, y1), (x2, y2) = on_uno[uno_pin, "end"], on_module[name]
        wires.append(([(x1, y1), (turn, y1), (turn, y2), (x2, y2)], style))
    for points, style in wires:
        p.line(points, style, halo=32)
        for place in (points[0], points[-1]):
            p.dot(*place, "solid" if "hot" in style else "dark", 3)
    notes(p)
    return p
