#ifndef ROIO_TESTS_LOCAL_RIG_HPP
#define ROIO_TESTS_LOCAL_RIG_HPP

#include <cstdlib>
#include <filesystem>
#include <roio.hpp>
#include <string>
#include <thread>

namespace roio::test {

/// What open() says when it refuses.
inline std::string refusal(const std::string& url) {
  try {
    const auto bus = open(url, {.open_timeout = std::chrono::milliseconds(300)});
  } catch (const std::system_error& error) {
    return error.what();
  }
  return "(opened)";
}

/// Bounded; the hub needs a moment to see who came and went.
inline bool becomes(const Bus& bus, std::size_t listeners) {
  for (const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
       std::chrono::steady_clock::now() < end;
       std::this_thread::sleep_for(std::chrono::milliseconds(1))) {
    if (bus.listeners() == listeners) {
      return true;
    }
  }
  return false;
}

/// A folder for buses of this test's own.
class RuntimeFolder {
 public:
  explicit RuntimeFolder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() / name) {
    ::setenv("ROIO_RUNTIME_DIR", path_.c_str(), 1);
  }
  RuntimeFolder(const RuntimeFolder&) = delete;
  RuntimeFolder& operator=(const RuntimeFolder&) = delete;
  ~RuntimeFolder() {
    ::unsetenv("ROIO_RUNTIME_DIR");
    std::filesystem::remove_all(path_);
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace roio::test

#endif
