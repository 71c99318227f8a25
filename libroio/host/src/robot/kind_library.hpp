#ifndef ROIO_ROBOT_KIND_LIBRARY_HPP
#define ROIO_ROBOT_KIND_LIBRARY_HPP

#include <filesystem>
#include <map>
#include <memory>
#include <roio/kind.hpp>
#include <roio/robot.hpp>
#include <string>
#include <vector>

#include "robot/at.hpp"

namespace roio::robot_file {

/// The kinds that a robot names, each read once, from the first folder that has it.
class KindLibrary {
 public:
  KindLibrary(const std::filesystem::path& robot_file, const LoadOptions& options);

  /// @param at where the kind is named. @throws Refused: it is nowhere, or its file is not right.
  std::shared_ptr<const Kind> get(const At& at);

 private:
  [[nodiscard]] std::vector<std::string> names() const;
  [[noreturn]] void refuse_unknown(const At& at, const std::string& name) const;

  std::vector<std::filesystem::path> folders_;
  std::map<std::string, std::shared_ptr<const Kind>> read_;
};

}  // namespace roio::robot_file

#endif
