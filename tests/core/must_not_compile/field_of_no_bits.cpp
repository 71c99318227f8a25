#include <roio/header.hpp>

#ifdef WITHOUT_MISTAKE
using Field = roio::IdField<0, 1>;
#else
using Field = roio::IdField<0, 0>;
#endif

uint32_t probe() {
  return Field::mask();
}
