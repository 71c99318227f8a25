/// A file that grows by whole records, whatever goes wrong.
#ifndef ROIO_CLI_RECORD_FILE_HPP
#define ROIO_CLI_RECORD_FILE_HPP

#include <cstdint>
#include <optional>
#include <string>

#include "form/record_format.hpp"

namespace roio::cli {

class RecordFile {
 public:
  /// @throws Failure: a regular file of that name is there. A pipe or a device may be written to.
  static void refuse_existing(const std::string& name);
  /// @return nothing: a signal came while a pipe waited for its reader.
  /// @throws Failure: it cannot be created, or is there and `force` is not set.
  static std::optional<RecordFile> create(const std::string& name, bool force);
  /// The same with a name made of this moment: "roio-2026-11-20_202026.log", or with "-2" and so on
  /// before its ending when there is one of that moment.
  static std::optional<RecordFile> create_dated(Form form);

  RecordFile(const RecordFile&) = delete;
  RecordFile& operator=(const RecordFile&) = delete;
  RecordFile(RecordFile&& other) noexcept;
  RecordFile& operator=(RecordFile&&) = delete;
  ~RecordFile();

  [[nodiscard]] const std::string& name() const { return name_; }

  /// Writes all of the buffer and empties it. What was written in part is taken back.
  /// @throws Failure: the disk is full, and the like; BrokenPipe: the pipe's reader has gone.
  void write(Buffer& records);
  /// @throws Failure: what was written may not be there.
  void close();

 private:
  RecordFile(int fd, std::string name);

  int fd_;
  std::string name_;
  std::uint64_t size_ = 0;  ///< Of whole records.
};

}  // namespace roio::cli

#endif
