"""How boards, simulated bus, local bus, roio-cli and a program of one's own join."""

from kit import Picture

COLUMNS = (32, 320, 608)  # left edges of the three ways to a bus
WIDTH = 240


def middle(column):
    return COLUMNS[column] + WIDTH // 2


def programs(p):
    p.titled(COLUMNS[0], 32, 384, 72, "roio-cli", ["listen, send, convert, look after a bridge"], name_style="bold mono")
    p.titled(464, 32, 384, 72, "your program", ["C++ and libroio"])
    p.box(COLUMNS[0], 136, 816, 48, "tint")
    p.lines(440, 160, ["libroio: one way to all of them, by the bus's name"], "bold accent", "middle")
    for x in (224, 656):
        p.arrow([(x, 104), (x, 132)], both=True)


def buses(p):
    for column, (name, what) in enumerate((("can0", "SocketCAN: a CAN adapter"),
                                           ("serial:/dev/ttyACM0", "the bridge: an Arduino on USB"),
                                           ("local:robot", "a bus between programs"))):
        p.arrow([(middle(column), 184), (middle(column), 220)], both=True)
        p.titled(COLUMNS[column], 224, WIDTH, 72, name, [what], name_style="bold mono")
    p.arrow([(COLUMNS[1] + WIDTH, 260), (COLUMNS[2], 260)], "hot dashed", both=True)
    p.line([(584, 264), (584, 312)], "thin")
    p.lines(584, 324, ["roio-cli bridge attach"], "small mono", "middle")


def real_bus(p):
    left, right, line = 56, 536, 364
    for x in (middle(0), middle(1)):
        p.line([(x, 296), (x, line)], "hot")
    p.line([(left, line), (right, line)], "hot")
    for x in (left, right):
        p.bar(x - 4, line - 12, 8, 24, "dark", 2)
    p.text(296, line - 16, "a CAN bus", "small muted", "middle")
    for x, name, address in ((152, "arm", "0.2"), (296, "sensors", "0.3"), (440, "lights", "0.4")):
        p.line([(x, line), (x, 408)], "hot")
        p.dot(x, line, "solid")
        p.titled(x - 64, 408, 128, 64, name, [address])
    p.text(296, 496, "Arduinos with an MCP2515", "muted", "middle")


def simulated_bus(p):
    left, right, line = 632, 824, 364
    p.box(608, 336, 240, 144, "frame", 8)
    p.line([(728, 296), (728, line)], "hot", halo=4)
    p.dot(728, line, "solid")
    p.line([(left, line), (right, line)], "hot")
    for x, name, address in ((676, "arm", "0.2"), (780, "sensors", "0.3")):
        p.line([(x, line), (x, 408)], "hot")
        p.dot(x, line, "solid")
        p.titled(x - 44, 408, 88, 64, name, [address])
    p.text(728, 496, "roio-sim: the same firmware", "muted", "middle")


def picture():
    p = Picture(880, 520, "How the parts of Roio join",
                "roio-cli and your own program use libroio, which opens a bus by its name: can0 is a CAN adapter under "
                "SocketCAN; serial:/dev/ttyACM0 is the bridge, an Arduino on USB; both lead to a CAN bus with Arduinos. "
                "local:robot is a bus between programs: roio-sim joins its simulated boards to it, and "
                "roio-cli bridge attach joins a bridge to it.")
    programs(p)
    buses(p)
    real_bus(p)
    simulated_bus(p)
    return p
