#include <roio/filter.hpp>

roio::Status probe(roio::FilterProgram<1>& program, const roio::FilterRule& rule) {
#ifndef WITHOUT_MISTAKE
  program.add(rule);  // whether there was room goes unseen
#endif
  return program.add(rule);
}
