"""The Roio block: MCP2515, transceiver, crystal, terminator, connectors. docs/hardware.md lists the parts."""

from kit import Picture

PIN = 24  # px of a pin's line outside its chip


def ground(p, x, y):
    """The sign for GND, below (x, y)."""
    p.line([(x, y), (x, y + 8)])
    for row, half in enumerate((8, 5, 2)):
        p.raw(f'<path d="M{x - half} {y + 8 + 4 * row}h{2 * half}" class="line"/>')


def supply(p, x, y, name):
    """The sign for a supply, above (x, y)."""
    p.line([(x, y), (x, y - 16)])
    p.raw(f'<path d="M{x - 8} {y - 16}h16" class="line hot"/>')
    p.text(x, y - 28, name, "small mono bold accent", "middle")


def capacitor(p, x, y, length, upright, label, label_at):
    """Two plates in the middle of a line of that length; the far end goes to GND."""
    half = length // 2
    if upright:
        p.line([(x, y), (x, y + half - 4)])
        p.line([(x, y + half + 4), (x, y + length)])
        for at in (-3, 3):
            p.raw(f'<path d="M{x - 10} {y + half + at}h20" class="line"/>')
        ground(p, x, y + length)
    else:
        p.line([(x, y), (x + half - 4, y)])
        p.line([(x + half + 4, y), (x + length, y)])
        for at in (-3, 3):
            p.raw(f'<path d="M{x + half + at} {y - 10}v20" class="line"/>')
        ground(p, x + length, y)
    p.text(*label_at, label, "small")


def chip(p, x, y, width, height, named_at, name, part, pins):
    """pins: (side, place along it, number, name). A pin's line ends PIN px outside."""
    p.box(x, y, width, height, "fill", 4)
    p.text(x + width / 2, named_at - 10, name, "bold", "middle")
    p.text(x + width / 2, named_at + 10, part, "small muted", "middle")
    for side, at, pin, label in pins:
        if side in "lr":
            out, edge, sign = ("end", x, -1) if side == "l" else ("start", x + width, 1)
            p.line([(edge, at), (edge + sign * PIN, at)])
            p.text(edge - sign * 6, at, label, "small mono", "start" if side == "l" else "end")
            p.text(edge + sign * 6, at - 9, str(pin), "small muted mono", out)
        else:
            edge, sign = (y, -1) if side == "t" else (y + height, 1)
            p.line([(at, edge), (at, edge + sign * PIN)])
            p.text(at, edge - sign * 12, label, "small mono", "middle")
            p.text(at + 6, edge + sign * 12, str(pin), "small muted mono")


def connector(p, x, y, width, height, side, names):
    p.box(x, y, width, height, "tint", 4)
    for at, name in names:
        p.text(x + (width - 10 if side == "r" else 10), at, name, "small mono bold", "end" if side == "r" else "start")
        p.dot(x + (width if side == "r" else 0), at, "solid")


def controller_side(p):
    connector(p, 40, 112, 72, 304, "r", [
        (136, "VIN"), (168, "5V"), (200, "VIO"), (232, "GND"), (264, "CS"), (296, "SO"), (328, "SI"), (360, "SCK"), (392, "INT")])
    p.lines(76, 436, [("J3", "bold"), ("to the Arduino", "small muted")], anchor="middle")
    p.line([(112, 136), (144, 136)])
    supply(p, 144, 136, "VIN")
    p.line([(112, 168), (192, 168)])
    supply(p, 192, 168, "5V")
    # JP2: two pads
    p.line([(152, 168), (152, 176)])
    p.line([(152, 192), (152, 200)])
    for y in (180, 188):
        p.dot(152, y, "open", 3)
    p.text(162, 184, "JP2", "small")
    p.line([(112, 200), (248, 200)])
    supply(p, 232, 200, "VIO")
    for x, y in ((152, 168), (152, 200), (232, 200)):
        p.dot(x, y, "dark", 3)
    p.resistor(232, 200, 56, upright=False)
    p.text(260, 220, "R1 10 kΩ", "small", "middle")
    p.line([(112, 232), (136, 232)])
    ground(p, 136, 232)
    for y in (264, 296, 328, 360, 392):
        p.line([(112, y), (288, y)])


def controller(p):
    chip(p, 312, 160, 160, 312, 304, "U1", "MCP2515", [
        ("l", 200, 17, "RESET"), ("l", 264, 16, "CS"), ("l", 296, 15, "SO"), ("l", 328, 14, "SI"), ("l", 360, 13, "SCK"),
        ("l", 392, 12, "INT"), ("r", 200, 1, "TXCAN"), ("r", 232, 2, "RXCAN"), ("r", 368, 8, "OSC1"),
        ("r", 432, 7, "OSC2"), ("t", 392, 18, "VDD"), ("b", 392, 9, "VSS")])
    p.line([(392, 136), (392, 96)])
    supply(p, 392, 96, "VIO")
    p.line([(392, 104), (440, 104)])
    p.dot(392, 104, "dark", 3)
    capacitor(p, 440, 104, 24, True, "C3 100 nF", (456, 116))
    ground(p, 392, 496)
    # the crystal, between its two capacitors
    for y in (368, 432):
        p.line([(496, y), (536, y)])
        p.dot(528, y, "dark", 3)
    p.line([(528, 368), (528, 388)])
    p.line([(528, 412), (528, 432)])
    p.raw('<path d="M518 388h20M518 412h20" class="line"/>')
    p.raw('<rect x="518" y="393" width="20" height="14" class="open"/>')
    p.text(548, 400, "Y1 16 MHz", "small")
    capacitor(p, 536, 368, 56, False, "C1 22 pF", (548, 346))
    capacitor(p, 536, 432, 56, False, "C2 22 pF", (548, 464))


def transceiver(p):
    p.line([(496, 200), (592, 200)])
    p.line([(496, 232), (592, 232)])
    chip(p, 616, 160, 128, 192, 304, "U2", "TJA1051T/3", [
        ("l", 200, 1, "TXD"), ("l", 232, 4, "RXD"), ("l", 304, 8, "S"), ("r", 200, 7, "CANH"), ("r", 264, 6, "CANL"),
        ("t", 656, 3, "VCC"), ("t", 704, 5, "VIO"), ("b", 680, 2, "GND")])
    ground(p, 592, 304)
    ground(p, 680, 376)
    for x, name, aside, label_at in ((656, "5V", 608, (552, 88)), (704, "VIO", 752, (768, 88))):
        p.line([(x, 136), (x, 96)])
        supply(p, x, 96, name)
        p.line([(x, 104), (aside, 104)])
        p.dot(x, 104, "dark", 3)
        label = "C4 100 nF" if name == "5V" else "C5 100 nF"
        capacitor(p, aside, 104, 24, True, label, (aside - 78, 116) if name == "5V" else (aside + 16, 116))


def bus_side(p):
    connector(p, 968, 176, 72, 256, "l", [(200, "CAN_H"), (264, "CAN_L"), (328, "GND"), (408, "V+")])
    p.lines(1004, 452, [("J1, J2", "bold"), ("bus in and out", "small muted")], anchor="middle")
    p.line([(768, 200), (968, 200)], "hot")
    p.line([(768, 264), (968, 264)], "hot")
    # the terminator with its jumper
    p.resistor(800, 200, 40, upright=True)
    for y in (244, 252):
        p.dot(800, y, "open", 3)
    p.line([(800, 256), (800, 264)])
    p.lines(814, 220, ["R2 120 Ω", "JP1"], "small", step=24)
    # against static discharge
    p.box(880, 296, 64, 32, "fill", 4)
    p.text(912, 312, "D1 ESD", "small", "middle")
    p.line([(896, 200), (896, 296)])
    p.line([(928, 264), (928, 296)])
    p.line([(880, 264), (912, 264)], "hot", halo=8)
    ground(p, 912, 328)
    for x, y in ((800, 200), (800, 264), (896, 200), (928, 264)):
        p.dot(x, y, "solid", 3)
    p.line([(968, 328), (956, 328)])
    ground(p, 956, 328)
    # the supply over the cable
    p.line([(968, 408), (936, 408)])
    p.resistor(880, 408, 56, upright=False)
    p.text(908, 388, "F1 0.5 A", "small", "middle")
    p.line([(880, 408), (752, 408)])
    p.raw('<path d="M840 398v20l-16-10z" class="dark"/><path d="M822 398v20" class="line"/>')
    p.text(832, 388, "D2", "small", "middle")
    supply(p, 752, 408, "VIN")


def picture():
    p = Picture(1080, 560, "The Roio block: schematic",
                "J3 leads to the Arduino: CS, SO, SI, SCK and INT go straight to the MCP2515, whose RESET is pulled up by "
                "10 kilo-ohms, and whose crystal of 16 MHz has 22 pF at each leg. TXCAN and RXCAN go to TXD and RXD of the "
                "transceiver TJA1051T/3, whose S is at GND. CANH and CANL go to two connectors, bus in and bus out, with 120 "
                "ohms and a jumper between them, and a diode against static discharge. V+ of the cable becomes VIN through "
                "a fuse and a diode. JP2 joins VIO to 5V for a controller of 5 V.")
    controller_side(p)
    controller(p)
    transceiver(p)
    bus_side(p)
    p.text(540, 532, "U1 open: 3 CLKOUT, 4 to 6 TXnRTS, 10 and 11 RXnBF.  JP1: closed at the two ends of the bus only.  "
           "JP2: closed for an Arduino of 5 V.", "small muted", "middle")
    return p
