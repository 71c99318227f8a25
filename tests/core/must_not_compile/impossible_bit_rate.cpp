#include <roio/bit_timing.hpp>

#ifdef WITHOUT_MISTAKE
constexpr uint32_t bitrate = 800000;
#else
constexpr uint32_t bitrate = 1000000;  // 8 MHz are 4 quanta a bit, one too few
#endif

roio::BitTiming probe() {
  return roio::bit_timing<8000000, bitrate>();
}
