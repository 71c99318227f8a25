#include <roio/header.hpp>

#ifdef WITHOUT_MISTAKE
using Field = roio::IdField<27, 2>;
#else
using Field = roio::IdField<28, 2>;  // bit 29 is no identifier bit
#endif

uint32_t probe() {
  return Field::mask();
}
