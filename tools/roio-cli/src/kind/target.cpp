#include "kind/target.hpp"

#include <cerrno>
#include <fstream>
#include <sstream>
#include <string_view>
#include <system_error>

#include "program/exit_status.hpp"
#include "program/output.hpp"

namespace roio::cli {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, int error) {
  throw Failure(file.string() + ": " + std::generic_category().message(error));
}

std::string read_all(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file)) {
    fail(file, EISDIR);
  }
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in.is_open() || in.bad()) {
    fail(file, errno == 0 ? EIO : errno);
  }
  return text.str();
}

void write_all(const std::filesystem::path& file, const std::string& text) {
  errno = 0;
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << text;
  out.close();
  if (!out) {
    fail(file, errno == 0 ? EIO : errno);
  }
}

void write_to_output(const std::string& text) {
  Buffer out;
  out.append(std::string_view(text));
  flush(out);
}

}  // namespace

void deliver(const std::string& text, const Target& target, const std::filesystem::path& source,
             const std::string& command) {
  if (!target.file) {
    write_to_output(text);
    return;
  }
  const std::filesystem::path& file = *target.file;
  if (target.check) {
    if (read_all(file) != text) {
      throw Failure(file.string() + ": is not what " + source.string() + " makes; `roio-cli " +
                    command + " -o " + file.string() + ' ' + source.string() + "` makes it anew");
    }
    return;
  }
  std::error_code unknown;  // one is not there, so they differ
  if (std::filesystem::equivalent(file, source, unknown)) {
    throw Failure(file.string() + ": is what would be read; expected another file to write");
  }
  write_all(file, text);
}

}  // namespace roio::cli
