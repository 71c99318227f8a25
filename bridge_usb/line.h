/// Line: what carries bytes to and from the PC on this board.
#ifndef ROIO_BRIDGE_LINE_H
#define ROIO_BRIDGE_LINE_H

#include "config.h"

#if defined(ROIO_BRIDGE_OVER_USB)
#include "line_usb.h"
namespace roio {
namespace bridge {
using Line = UsbLine;
}  // namespace bridge
}  // namespace roio
#else
#include "line_uart.h"
namespace roio {
namespace bridge {
using Line = UartLine;
}  // namespace bridge
}  // namespace roio
#endif

#endif
