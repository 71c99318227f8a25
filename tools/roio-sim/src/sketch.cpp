#include "sketch.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <optional>
#include <roio/version.hpp>
#include <system_error>
#include <utility>

#include "interrupt.hpp"
#include "program/exit_status.hpp"
#include "program/share.hpp"

namespace roio::sim_tool {
namespace {

constexpr int between_looks_ms = 100;  // for a signal that came just before a wait

// What is built with.
struct Kit {
  std::filesystem::path script;
  std::filesystem::path library;
};

Kit find_kit() {
  const auto share = cli::share_folder();
  Kit kit{share / "arduino_image.py", share / "Roio-" ROIO_VERSION ".zip"};
  for (const auto& file : {kit.script, kit.library}) {
    if (!std::filesystem::exists(file)) {
      throw cli::Failure(file.string() + ": no such file; a sketch is built with it");
    }
  }
  return kit;
}

// A program whose standard output is read; it ends before this does.
class Child {
 public:
  explicit Child(std::vector<std::string> words) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
      throw std::system_error(errno, std::generic_category(), "pipe");
    }
    output_ = ends[0];
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    // Standard input is for commands.
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (std::string& word : words) {
      arguments.push_back(word.data());
    }
    arguments.push_back(nullptr);
    const int error =
        ::posix_spawnp(&id_, arguments[0], &actions, nullptr, arguments.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    if (error != 0) {
      ::close(output_);
      throw std::system_error(error, std::generic_category(), words[0]);
    }
  }
  ~Child() {
    end();
    ::close(output_);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// All that it wrote until its end; a signal that comes meanwhile ends it.
  std::string read() {
    std::string text;
    for (;;) {
      pollfd wait{output_, POLLIN, 0};
      const int ready = ::poll(&wait, 1, between_looks_ms);
      if (caught_signal() != 0) {
        end();
        return text;
      }
      if (ready <= 0) {
        continue;
      }
      std::array<char, 4096> buffer{};
      const ssize_t count = ::read(output_, buffer.data(), buffer.size());
      if (count == 0 || (count < 0 && errno != EINTR)) {
        return text;
      }
      text.append(buffer.data(), static_cast<std::size_t>(count > 0 ? count : 0));
    }
  }
  /// @return as a shell has it.
  int wait() {
    int status = 0;
    while (::waitpid(std::exchange(id_, 0), &status, 0) < 0 && errno == EINTR) {
    }
    return WIFSIGNALED(status) ? cli::exit_signal + WTERMSIG(status) : WEXITSTATUS(status);
  }

 private:
  // It cleans up, and takes the compilers with it.
  void end() {
    if (id_ > 0) {
      ::kill(id_, SIGTERM);
      static_cast<void>(wait());
    }
  }

  pid_t id_ = 0;
  int output_ = -1;
};

// The image's path; none: an error that was told, and then `status` is not 0.
std::optional<std::string> build(const Kit& kit, const BoardWish& board, int& status) {
  try {
    Child child({"python3", kit.script, "--tool", "roio-sim", "--board", board.kind_word,
                 "--library", kit.library, "--", board.elf});
    std::string image = child.read();
    if (const int signal = caught_signal()) {
      status = cli::exit_signal + signal;
      return std::nullopt;
    }
    status = child.wait();
    if (status != 0) {
      return std::nullopt;
    }
    image.resize(image.empty() ? 0 : image.size() - 1);  // the line's end
    return image;
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::no_such_file_or_directory) {
      throw cli::Failure(
          "python3 is missing, which builds sketches; on Debian: sudo apt-get install "
          "python3");
    }
    throw;
  }
}

}  // namespace

bool is_sketch(const std::string& path) {
  std::error_code not_there;
  return path.ends_with(".ino") || std::filesystem::is_directory(path, not_there);
}

int build_sketches(std::vector<BoardWish>& boards) {
  std::optional<Kit> kit;
  for (BoardWish& board : boards) {
    if (!is_sketch(board.elf)) {
      continue;
    }
    if (!kit) {
      kit = find_kit();
    }
    int status = 0;
    const auto image = build(*kit, board, status);
    if (!image) {
      return status;
    }
    board.elf = *image;
  }
  return 0;
}

}  // namespace roio::sim_tool
