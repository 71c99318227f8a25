#include <algorithm>
#include <cerrno>
#include <optional>
#include <roio/sim/serial_pty.hpp>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "board/pty_terminal.hpp"
#include "board/uart_sampling.hpp"

namespace roio::sim {
namespace {

constexpr double bits_of_a_byte = 10;
constexpr double usb_bps = 12e6;
// So much more than an interval takes is kept waiting for the board. The rest stays in the
// terminal, where its writer sees it.
constexpr std::size_t bytes_ahead = 16;
// A session that its bridge has given up, or not yet, is over by then.
constexpr SimTime longest_change = std::chrono::seconds(2);

std::string target_of(const std::filesystem::path& link) {
  std::error_code not_one;
  return std::filesystem::read_symlink(link, not_one).string();
}

// A symbolic link to a terminal that comes and goes.
class TerminalLink {
 public:
  explicit TerminalLink(std::filesystem::path path) : path_(std::move(path)) {}
  ~TerminalLink() { remove(); }
  TerminalLink(const TerminalLink&) = delete;
  TerminalLink& operator=(const TerminalLink&) = delete;

  void lead_to(const std::string& terminal) {
    if (path_.empty()) {
      return;
    }
    if (target_of(path_).starts_with("/dev/pts/")) {
      std::filesystem::remove(path_);  // of one that was killed
    }
    std::error_code error;
    std::filesystem::create_symlink(terminal, path_, error);
    if (error) {
      const bool taken = error == std::errc::file_exists;
      throw std::system_error(
          error, path_.string() +
                     (taken ? ": expected nothing there, or a link to a pseudo terminal" : ""));
    }
    target_ = terminal;
  }
  // Unless another has taken the place.
  void remove() {
    if (!target_.empty() && target_of(path_) == target_) {
      std::error_code gone;
      std::filesystem::remove(path_, gone);
    }
    target_.clear();
  }

 private:
  std::filesystem::path path_;
  std::string target_;
};

// Bytes at a rate that the other end did not have: on the way from one rate to another, or because
// a program's rate is wrong.
class Garble {
 public:
  /// A new terminal: nobody knows its rate.
  void begin() {
    wrong_ += was_understood_ ? 0 : pending_;
    pending_ = 0;
    since_.reset();
    was_understood_ = false;
  }
  void understood() {
    pending_ = 0;
    since_.reset();
    was_understood_ = true;
  }
  void add(std::size_t count, SimTime now) {
    all_ += count;
    pending_ += count;
    if (!since_) {
      since_ = now;
    }
    if (now - *since_ >= longest_change) {
      wrong_ += std::exchange(pending_, 0);
    }
  }

  [[nodiscard]] std::uint64_t all() const { return all_; }
  [[nodiscard]] std::uint64_t by_wrong_rate() const {
    return wrong_ + (was_understood_ ? 0 : pending_);
  }

 private:
  std::uint64_t all_ = 0;
  std::uint64_t wrong_ = 0;
  std::uint64_t pending_ = 0;  // since a byte came through; not in wrong_
  std::optional<SimTime> since_;
  bool was_understood_ = false;
};

}  // namespace

class SerialPty::Line : public std::enable_shared_from_this<SerialPty::Line> {
 public:
  Line(CanBus& bus, Board& board, int uart, const SerialPtyOptions& options)
      : bus_(bus), board_(board), uart_(uart), interval_(options.interval), link_(options.link) {
    if (interval_ <= SimTime(0)) {
      throw std::invalid_argument("a SerialPty needs an interval above 0");
    }
  }

  void plug() {
    if (terminal_) {
      return;
    }
    terminal_.emplace();
    try {
      link_.lead_to(terminal_->path());
    } catch (...) {
      terminal_.reset();
      throw;
    }
    path_ = terminal_->path();
    garble_.begin();
  }
  void unplug() {
    unheard_ += std::exchange(from_board_, {}).size();
    link_.remove();
    path_.clear();
    terminal_.reset();
  }

  void look() {
    hand_on();
    fetch();
    bus_.after(interval_, [weak = weak_from_this()] {
      if (const auto self = weak.lock()) {
        self->look();
      }
    });
  }

  void put(std::uint8_t byte) {
    if (!terminal_) {
      ++unheard_;
      return;
    }
    const std::optional<double> bitrate_bps = board_.serial_sent_bitrate_bps(uart_);
    if (bitrate_bps != from_board_bps_) {
      hand_on();
      from_board_bps_ = bitrate_bps;
    }
    from_board_.push_back(byte);
  }

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] bool is_plugged() const { return terminal_.has_value(); }
  [[nodiscard]] std::uint64_t lost() const { return lost_; }
  [[nodiscard]] std::uint64_t unheard() const { return unheard_; }
  [[nodiscard]] const Garble& garble() const { return garble_; }

 private:
  // Whether bytes between the two come through; if not, they are counted.
  bool come_through(std::optional<double> terminal_bps, std::optional<double> board_bps,
                    std::size_t count) {
    if (!terminal_bps || !board_bps) {
      return true;
    }
    if (rates_match(*terminal_bps, *board_bps)) {
      garble_.understood();
      return true;
    }
    garble_.add(count, bus_.now());
    return false;
  }

  // To the terminal, all that the board has sent since the last time, in one system call.
  void hand_on() {
    if (from_board_.empty()) {
      return;
    }
    const auto terminal_bps = terminal_->bitrate_bps();
    if (!come_through(terminal_bps, from_board_bps_, from_board_.size())) {
      from_board_ = sampled(from_board_, *from_board_bps_, *terminal_bps);
    }
    lost_ += from_board_.size() - terminal_->write(from_board_);
    from_board_.clear();
  }

  // From the terminal, as much as the board takes until the next look, and some.
  void fetch() {
    if (!terminal_) {
      return;
    }
    const std::optional<double> board_bps = board_.serial_bitrate_bps(uart_);
    const double seconds = std::chrono::duration<double>(interval_).count();
    const auto most = bytes_ahead + static_cast<std::size_t>(
                                        2 * seconds * board_bps.value_or(usb_bps) / bits_of_a_byte);
    const std::size_t waiting = board_.serial_waiting(uart_);
    if (waiting >= most) {
      return;
    }
    to_board_.resize(most - waiting);
    to_board_.resize(terminal_->read(to_board_));
    if (to_board_.empty()) {
      return;
    }
    const auto terminal_bps = terminal_->bitrate_bps();
    if (!come_through(terminal_bps, board_bps, to_board_.size())) {
      to_board_ = sampled(to_board_, *terminal_bps, *board_bps);
    }
    board_.serial_write(uart_, to_board_);
  }

  CanBus& bus_;
  Board& board_;
  int uart_;
  SimTime interval_;
  std::optional<PtyTerminal> terminal_;
  std::string path_;
  TerminalLink link_;
  std::vector<std::uint8_t> from_board_;  // sent, and not handed on
  std::optional<double> from_board_bps_;  // of these; none: USB
  std::vector<std::uint8_t> to_board_;
  std::uint64_t lost_ = 0;
  std::uint64_t unheard_ = 0;
  Garble garble_;
};

SerialPty::SerialPty(CanBus& bus, Board& board, int uart, const SerialPtyOptions& options)
    : line_(std::make_shared<Line>(bus, board, uart, options)), board_(board), uart_(uart) {
  line_->plug();
  board.on_serial(uart, [line = line_](std::uint8_t byte) { line->put(byte); });
  line_->look();
}

SerialPty::~SerialPty() {
  board_.on_serial(uart_, nullptr);
}

const std::string& SerialPty::path() const {
  return line_->path();
}
void SerialPty::unplug() {
  line_->unplug();
}
void SerialPty::plug() {
  line_->plug();
}
bool SerialPty::is_plugged() const {
  return line_->is_plugged();
}
std::uint64_t SerialPty::lost() const {
  return line_->lost();
}
std::uint64_t SerialPty::unheard() const {
  return line_->unheard();
}
std::uint64_t SerialPty::garbled() const {
  return line_->garble().all();
}
std::uint64_t SerialPty::garbled_by_wrong_rate() const {
  return line_->garble().by_wrong_rate();
}

}  // namespace roio::sim
