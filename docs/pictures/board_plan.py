"""Where the parts go on a board of 5 x 5 cm that carries an Arduino Nano: 8 px a millimetre."""

from kit import Picture

SCALE, LEFT, TOP = 8, 56, 56
SIZE = 50  # mm

# name, x, y, width, height in mm from the board's upper left corner, how it is drawn
PARTS = [
    ("U3 Arduino Nano", 2.5, 8, 45, 18, "fill"),
    ("U1", 6, 28, 12, 10.5, "tint"), ("C3", 2, 28, 2.5, 2, "tint"), ("R1", 2, 31.5, 2.5, 2, "tint"),
    ("JP2", 20, 29.5, 4, 2, "tint"), ("Y1", 20, 33.5, 11, 4.5, "tint"),
    ("C1", 20, 39.5, 2.5, 2, "tint"), ("C2", 24, 39.5, 2.5, 2, "tint"),
    ("C4", 33.5, 28, 2.5, 2, "tint"), ("C5", 37, 28, 2.5, 2, "tint"), ("U2", 33.5, 31, 5, 6, "tint"),
    ("R2", 33, 38.5, 4, 2, "tint"), ("JP1", 38.5, 38.5, 5, 3, "tint"), ("D1", 40, 34, 3.5, 2.5, "tint"),
    ("D2", 44.5, 28, 3, 5, "tint"), ("F1", 44.5, 34.5, 3, 4, "tint"),
    ("J1 bus in", 8.5, 42.5, 14, 7.5, "fill"), ("J2 bus out", 27.5, 42.5, 14, 7.5, "fill"),
]
HOLES = [(4, 4), (46, 4), (4, 46), (46, 46)]
NOTES = [
    ("J1 and J2 side by side", "the cable passes through: the stub is 1 cm of track"),
    ("U2, D1, R2 next to J1 and J2", "CAN_H and CAN_L as a pair, without a via"),
    ("Y1, C1, C2 at pins 7 and 8 of U1", "short, nothing else between them"),
    ("C3, C4, C5", "right at the supply pins 18 of U1, 3 and 5 of U2"),
    ("F1, D2", "V+ of the cable to VIN of the Nano"),
    ("Two layers", "the lower one is GND, as whole as can be"),
]


def px(millimetres):
    return round(millimetres * SCALE)


def picture():
    p = Picture(960, 512, "A board of 5 x 5 cm: where the parts go",
                "The Nano lies along the upper edge with its USB socket to the left. Below it are, from left to right, the "
                "MCP2515 U1, the crystal Y1 with its capacitors, and the transceiver U2. At the lower edge the connectors J1 "
                "and J2 take the bus in and out; the terminator R2 and its jumper JP1 are next to them.")
    p.box(LEFT, TOP, px(SIZE), px(SIZE), "board", 16)
    p.rules += ".board{fill:var(--card);stroke:var(--ink);stroke-width:2}"
    for x, y in HOLES:
        p.dot(LEFT + px(x), TOP + px(y), "open", px(1.6))
    for name, x, y, width, height, style in PARTS:
        p.box(LEFT + px(x), TOP + px(y), px(width), px(height), style, 2)
        small = width < 9
        p.text(LEFT + px(x + width / 2), TOP + px(y + height / 2), name,
               "tiny bold" if small else "bold", "middle")
    p.rules += ".tiny{font-size:11px}"
    nano = PARTS[0]
    for row in (9.5, 24.5):
        for pin in range(15):
            p.bar(LEFT + px(nano[1] + 4.5) + pin * 20, TOP + px(row) - 4, 8, 8, "dark", 4)
    p.box(LEFT + px(1), TOP + px(13), px(6), px(8), "open", 2)
    p.text(LEFT + px(4), TOP + px(17), "USB", "tiny", "middle")
    for connector in PARTS[-2:]:
        for pin in range(4):
            p.dot(LEFT + px(connector[1] + 1.5) + pin * 28 + 4, TOP + px(48), "dark", 4)
    p.measure((LEFT, 36), (LEFT + px(SIZE), 36))
    p.text(LEFT + px(SIZE / 2), 20, "50 mm", "small muted", "middle")
    p.measure((36, TOP), (36, TOP + px(SIZE)))
    p.raw(f'<text transform="translate(24 {TOP + px(SIZE / 2)}) rotate(-90)" class="small muted" '
          f'text-anchor="middle">50 mm</text>')
    for row, (what, why) in enumerate(NOTES):
        p.lines(500, 84 + 64 * row, [(what, "bold"), (why, "small muted")])
    p.text(256, 484, "SO, SOT and 0805 cases: soldered by hand", "small muted", "middle")
    return p
