/// Fits a filter program to SocketCAN: struct can_filter, one a rule.
/// Source: Linux Documentation/networking/can.rst "RAW socket option CAN_RAW_FILTER".
#ifndef ROIO_FILTER_SOCKETCAN_HPP
#define ROIO_FILTER_SOCKETCAN_HPP

#include <stdint.h>

#include <roio/filter.hpp>
#include <roio/frame.hpp>

namespace roio {

/// The same two words as the kernel's struct can_filter, in terms of tagged identifiers
/// (frame.hpp). Accepts a frame when (tagged_id & can_mask) == (can_id & can_mask); with bit 29 set
/// in can_id, when they differ. Bit 29 of can_mask is the kernel's own (error frames) and stays 0.
struct SocketCanFilter {
  uint32_t can_id;
  uint32_t can_mask;
};

namespace socketcan {
constexpr uint32_t extended_flag = UINT32_C(0x80000000);  ///< CAN_EFF_FLAG
constexpr uint32_t remote_flag = UINT32_C(0x40000000);    ///< CAN_RTR_FLAG
constexpr uint32_t error_flag = UINT32_C(0x20000000);     ///< CAN_ERR_FLAG
constexpr uint32_t inverted = UINT32_C(0x20000000);       ///< CAN_INV_FILTER, in can_id
}  // namespace socketcan

/// One rule, for extended data frames only: the extended and the remote flag are part of the mask,
/// so neither an 11-bit nor a remote frame gets through. Always exact.
constexpr SocketCanFilter to_socketcan(const FilterRule& rule) {
  return SocketCanFilter{rule.match | socketcan::extended_flag,
                         rule.mask | socketcan::extended_flag | socketcan::remote_flag};
}

/// The mask as the kernel applies it: a filter for standard frames only (the extended flag in
/// can_mask, not in can_id) compares no identifier bit above the 11.
constexpr uint32_t effective_mask(const SocketCanFilter& filter) {
  return (filter.can_mask & socketcan::extended_flag) != 0 &&
                 (filter.can_id & socketcan::extended_flag) == 0
             ? filter.can_mask &
                   (max_id(FrameKind::standard) | socketcan::extended_flag | socketcan::remote_flag)
             : filter.can_mask & ~socketcan::error_flag;
}

/// What the kernel does with a filter, for backends that have no kernel behind them. Not for error
/// reports, which the kernel filters by other means.
constexpr bool accepts(const SocketCanFilter& filter, uint32_t tagged) {
  return (((tagged ^ filter.can_id) & effective_mask(filter)) == 0) !=
         ((filter.can_id & socketcan::inverted) != 0);
}

}  // namespace roio

#endif
