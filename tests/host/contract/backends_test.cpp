#include <algorithm>
#include <iostream>

#include "contract.hpp"

namespace roio::test {
namespace {

TEST(Backends, ThatThisRunCovers) {
  std::vector<std::string> names;
  for (const Backend& backend : backends()) {
    names.push_back(backend.name);
    std::cout << "backend: " << backend.name << ", for instance " << backend.fresh().url << '\n';
  }
  EXPECT_GE(names.size(), 3U);
  EXPECT_EQ(std::count(names.begin(), names.end(), "socketcan"),
            std::getenv("ROIO_TEST_CAN") != nullptr ? 1 : 0);
}

}  // namespace
}  // namespace roio::test
