/// Bit timing: how an MCP2515 divides its oscillator into bits, and where in a bit it looks at the
/// bus.
///
///   | sync |  prop_seg  |  phase_seg1  |  phase_seg2  |
///   |  1   |   1 .. 8   |    1 .. 8    |    2 .. 8    |   time quanta: 5 .. 25 a bit
///                                      ^ sample point
///
/// A quantum is 2 * prescaler clocks of the oscillator. Pure functions, no state; the same at
/// compile time and at run time. Source: MCP2515 datasheet DS20001801, section 5.
#ifndef ROIO_BIT_TIMING_HPP
#define ROIO_BIT_TIMING_HPP

#include <stdint.h>

namespace roio {

struct BitTiming {
  uint8_t prescaler;     ///< 1..64.
  uint8_t prop_seg;      ///< 1..8 quanta, for the way there and back on the bus.
  uint8_t phase_seg1;    ///< 1..8 quanta, lengthened to follow a late edge.
  uint8_t phase_seg2;    ///< 2..8 quanta, shortened to follow an early one.
  uint8_t sjw;           ///< 1..4 quanta: how far a phase segment changes at once.
  bool triple_sampling;  ///< Two more looks, half a quantum apart, before the sample point.
};

constexpr bool operator==(const BitTiming& a, const BitTiming& b) {
  return a.prescaler == b.prescaler && a.prop_seg == b.prop_seg && a.phase_seg1 == b.phase_seg1 &&
         a.phase_seg2 == b.phase_seg2 && a.sjw == b.sjw && a.triple_sampling == b.triple_sampling;
}
constexpr bool operator!=(const BitTiming& a, const BitTiming& b) {
  return !(a == b);
}

namespace detail {

constexpr uint8_t max_prescaler = 64;
constexpr uint8_t max_segment = 8;
constexpr uint8_t min_phase_seg2 = 2;  ///< The chip's information processing time.
constexpr uint8_t max_sjw = 4;
constexpr uint8_t min_quanta = 5;
constexpr uint8_t max_quanta = 25;

constexpr bool is_in(uint8_t value, uint8_t least, uint8_t most) {
  return value >= least && value <= most;
}

}  // namespace detail

/// Whether the chip may be set to this: each field in its range, prop_seg + phase_seg1 not below
/// phase_seg2, sjw below phase_seg2. An all-zero BitTiming is not valid.
constexpr bool is_valid(const BitTiming& timing) {
  return detail::is_in(timing.prescaler, 1, detail::max_prescaler) &&
         detail::is_in(timing.prop_seg, 1, detail::max_segment) &&
         detail::is_in(timing.phase_seg1, 1, detail::max_segment) &&
         detail::is_in(timing.phase_seg2, detail::min_phase_seg2, detail::max_segment) &&
         detail::is_in(timing.sjw, 1, detail::max_sjw) &&
         timing.prop_seg + timing.phase_seg1 >= timing.phase_seg2 && timing.phase_seg2 > timing.sjw;
}

/// Time quanta of one bit, the sync segment among them: 5..25 when the timing is valid.
constexpr uint16_t quanta_per_bit(const BitTiming& timing) {
  return static_cast<uint16_t>(1U + timing.prop_seg + timing.phase_seg1 + timing.phase_seg2);
}

/// The rate that this oscillator really gives, rounded down; 0 when the timing is not valid.
constexpr uint32_t bitrate_bps(const BitTiming& timing, uint32_t osc_hz) {
  return is_valid(timing) ? osc_hz / (2U * timing.prescaler * quanta_per_bit(timing)) : 0U;
}

/// Where in the bit the bus is sampled, in thousandths of it, rounded down; 0 when the timing is
/// not valid.
constexpr uint16_t sample_point_permille(const BitTiming& timing) {
  return is_valid(timing)
             ? static_cast<uint16_t>(1000U * (1U + timing.prop_seg + timing.phase_seg1) /
                                     quanta_per_bit(timing))
             : uint16_t{0};
}

/// What Linux aims at unless told otherwise (CiA's advice), so that both ends of a bus agree.
constexpr uint16_t default_sample_point_permille(uint32_t bitrate_bps) {
  return bitrate_bps > 800000U ? 750 : bitrate_bps > 500000U ? 800 : 875;
}

namespace detail {

/// What is asked for, within is_in_reach().
struct WantedBit {
  uint32_t osc_hz;
  uint32_t bitrate_bps;
  uint16_t sample_point;  ///< 0..1000.
};

constexpr uint32_t max_bitrate_bps = 1000000;  ///< Of classic CAN, and of the chip.
constexpr uint8_t rate_tolerance = 200;        ///< One part in so many.
constexpr uint32_t none = UINT32_MAX;          ///< An error: that is no timing at all.

/// No faster than the bus goes; and keeps what is below from dividing by zero and from wrapping. No
/// bit is shorter than 10 clocks, so what this refuses besides has no timing anyway. 8 costs no
/// division.
constexpr bool is_in_reach(uint32_t osc_hz, uint32_t bitrate_bps) {
  return osc_hz > 0U && bitrate_bps > 0U && bitrate_bps <= max_bitrate_bps &&
         bitrate_bps - 1U <= osc_hz / 8U;
}

constexpr uint8_t checked_prescaler(uint32_t prescaler) {
  return prescaler <= max_prescaler ? static_cast<uint8_t>(prescaler) : uint8_t{0};
}
/// That comes closest to the wanted length with this many quanta; 0 when none does.
constexpr uint8_t prescaler_for(const WantedBit& bit, uint8_t quanta) {
  return checked_prescaler((bit.osc_hz / (bit.bitrate_bps * quanta) + 1U) / 2U);
}

/// |osc / clocks - bitrate| in whole bit/s: 0 is the very rate.
constexpr uint32_t rate_error(const WantedBit& bit, uint32_t clocks) {
  return clocks == 0U
             ? none
             : (bit.osc_hz > bit.bitrate_bps * clocks ? bit.osc_hz - bit.bitrate_bps * clocks
                                                      : bit.bitrate_bps * clocks - bit.osc_hz) /
                   clocks;
}

constexpr uint8_t larger(uint8_t a, uint8_t b) {
  return a > b ? a : b;
}
constexpr uint8_t smaller(uint8_t a, uint8_t b) {
  return a < b ? a : b;
}

// Of so many quanta, how few and how many the chip lets lie before the sample point: segments of
// at most 8, at least 2 after it, and no more after it than in prop_seg + phase_seg1.
constexpr uint8_t fewest_before(uint8_t quanta) {
  return larger(static_cast<uint8_t>(quanta / 2U + 1U),
                static_cast<uint8_t>(quanta < max_segment ? 0 : quanta - max_segment));
}
constexpr uint8_t most_before(uint8_t quanta) {
  return smaller(1U + 2U * max_segment, static_cast<uint8_t>(quanta - min_phase_seg2));
}

/// As late as may be without passing the sample point asked for, as Linux does. Compared in whole
/// thousandths: 833 asks for 10 of 12.
constexpr uint8_t quanta_before_sample(uint8_t quanta, uint16_t sample_point) {
  return larger(fewest_before(quanta),
                smaller(most_before(quanta),
                        static_cast<uint8_t>(((sample_point + 1U) * quanta - 1U) / 1000U)));
}

/// Thousandths from the sample point asked for; being late weighs more than the worst early one.
constexpr uint16_t sample_point_error(uint16_t real, uint16_t asked) {
  return static_cast<uint16_t>(real <= asked ? asked - real : 1000U + real - asked);
}

/// The rate counts more than the sample point.
constexpr uint32_t error_of(uint32_t rate_off, uint16_t sample_point_off, uint32_t bitrate_bps) {
  return rate_off > bitrate_bps / rate_tolerance ? none : rate_off * 2048U + sample_point_off;
}
constexpr uint32_t error_of(const WantedBit& bit, uint8_t quanta) {
  return error_of(
      rate_error(bit, 2U * quanta * prescaler_for(bit, quanta)),
      sample_point_error(
          static_cast<uint16_t>(1000U * quanta_before_sample(quanta, bit.sample_point) / quanta),
          bit.sample_point),
      bit.bitrate_bps);
}

/// Tries `quanta` and everything below; on equal terms the best so far stays. A loop to an
/// optimising compiler, and 21 deep to any other.
/// @return 0: none.
constexpr uint8_t best_quanta(const WantedBit& bit, uint8_t quanta, uint8_t best, uint32_t error) {
  return quanta < min_quanta ? best
         : error_of(bit, quanta) < error
             ? best_quanta(bit, static_cast<uint8_t>(quanta - 1U), quanta, error_of(bit, quanta))
             : best_quanta(bit, static_cast<uint8_t>(quanta - 1U), best, error);
}

constexpr BitTiming from_segments(uint8_t prescaler, uint8_t seg1, uint8_t seg2) {
  return BitTiming{prescaler,
                   static_cast<uint8_t>(seg1 / 2U),
                   static_cast<uint8_t>(seg1 - seg1 / 2U),
                   seg2,
                   smaller(max_sjw, smaller(static_cast<uint8_t>(seg1 - seg1 / 2U),
                                            static_cast<uint8_t>(seg2 / 2U))),
                   false};
}

constexpr BitTiming from_quanta(uint8_t prescaler, uint8_t quanta, uint8_t before) {
  return from_segments(prescaler, static_cast<uint8_t>(before - 1U),
                       static_cast<uint8_t>(quanta - before));
}

constexpr BitTiming timing_of(const WantedBit& bit, uint8_t quanta) {
  return quanta == 0 ? BitTiming{}
                     : from_quanta(prescaler_for(bit, quanta), quanta,
                                   quanta_before_sample(quanta, bit.sample_point));
}

constexpr BitTiming best_timing(const WantedBit& bit) {
  return timing_of(bit, best_quanta(bit, max_quanta, 0, none));
}

}  // namespace detail

/// Searches the timing whose sample point comes closest to the one asked for, among those whose
/// real rate is less than 1 bit/s from the one asked for; when there is none, among those of the
/// one rate that is closest to it, if that is within 0.5 %. As in Linux, a sample point that is not
/// later than asked wins over any that is; on equal terms the one of more quanta. Without triple
/// sampling; sjw as wide as sensible: 4, but no wider than phase_seg1 or half of phase_seg2.
/// @param osc_hz of the crystal itself; the chip takes 1 to 40 MHz, which is not checked here.
/// @param bitrate_bps up to 1 Mbit/s, what CAN and the chip are made for.
/// @param sample_point_permille more than 1000 counts as 1000.
/// @return what bitrate_bps() tells the real rate of; all zero, so not valid, when no timing comes
/// within 0.5 % of the rate.
/// Cost at run time on AVR: some milliseconds at 16 MHz, 40 bytes of stack, 1,050 bytes of flash
/// and the divisions. bit_timing() below costs none of it.
constexpr BitTiming compute_bit_timing(uint32_t osc_hz, uint32_t bitrate_bps,
                                       uint16_t sample_point_permille) {
  return detail::is_in_reach(osc_hz, bitrate_bps)
             ? detail::best_timing(detail::WantedBit{
                   osc_hz, bitrate_bps,
                   sample_point_permille < 1000 ? sample_point_permille : uint16_t{1000}})
             : BitTiming{};
}

/// The same, with Linux's sample point for that rate.
constexpr BitTiming compute_bit_timing(uint32_t osc_hz, uint32_t bitrate_bps) {
  return compute_bit_timing(osc_hz, bitrate_bps, default_sample_point_permille(bitrate_bps));
}

namespace detail {

template <uint32_t OscHz, uint32_t BitrateBps, uint16_t SamplePointPermille>
struct ComputedBitTiming {
  static constexpr BitTiming value = compute_bit_timing(OscHz, BitrateBps, SamplePointPermille);
  static_assert(is_valid(value),
                "no bit timing comes within 0.5 % of this bit rate with this oscillator");
};

}  // namespace detail

/// The same for what is known when compiling: an impossible pair does not compile.
template <uint32_t OscHz, uint32_t BitrateBps,
          uint16_t SamplePointPermille = default_sample_point_permille(BitrateBps)>
constexpr BitTiming bit_timing() {
  // Field by field: a compiler may leave a whole constant to the run time, but no single number.
  using Computed = detail::ComputedBitTiming<OscHz, BitrateBps, SamplePointPermille>;
  return BitTiming{Computed::value.prescaler,  Computed::value.prop_seg,
                   Computed::value.phase_seg1, Computed::value.phase_seg2,
                   Computed::value.sjw,        Computed::value.triple_sampling};
}

/// The timings of the original Roio of 2014, for a bus that still has its nodes. Their sample
/// points are earlier than those above. For an oscillator of 16 MHz only.
/// @param kbps 1000, 500, 250, 125 or 10.
/// @return all zero, so not valid, for any other.
constexpr BitTiming original_bit_timing(uint16_t kbps) {
  return kbps == 1000  ? BitTiming{1, 1, 3, 3, 1, false}
         : kbps == 500 ? BitTiming{1, 3, 6, 6, 1, false}
         : kbps == 250 ? BitTiming{4, 1, 3, 3, 1, false}
         : kbps == 125 ? BitTiming{4, 3, 6, 6, 1, false}
         : kbps == 10  ? BitTiming{40, 5, 7, 7, 1, true}
                       : BitTiming{};
}

}  // namespace roio

#endif
