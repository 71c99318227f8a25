#include "robot/kind_library.hpp"

#include <cstdlib>
#include <string_view>
#include <system_error>

#include "robot/alike.hpp"
#include "robot/kind_reader.hpp"

namespace roio::robot_file {
namespace {

namespace fs = std::filesystem;

std::string environment(const char* name, const std::string& otherwise) {
  const char* value = std::getenv(name);
  return value != nullptr && *value != '\0' ? value : otherwise;
}

/// As the XDG Base Directory Specification has them: the user's own first, absolute ones alone.
std::vector<fs::path> data_folders() {
  const std::string home = environment("HOME", "");
  std::string list =
      environment("XDG_DATA_HOME", home.empty() ? std::string() : home + "/.local/share") + ':' +
      environment("XDG_DATA_DIRS", "/usr/local/share:/usr/share");
  std::vector<fs::path> folders;
  std::string_view rest = list;
  while (!rest.empty()) {
    const std::size_t colon = std::min(rest.find(':'), rest.size());
    const fs::path folder = rest.substr(0, colon);
    if (folder.is_absolute()) {
      folders.push_back(folder);
    }
    rest.remove_prefix(std::min(colon + 1, rest.size()));
  }
  return folders;
}

std::vector<fs::path> kind_folders(const fs::path& robot_file, const LoadOptions& options) {
  const fs::path own = robot_file.parent_path();
  std::vector<fs::path> folders = {own, own / "kinds"};
  folders.insert(folders.end(), options.kind_folders.begin(), options.kind_folders.end());
  for (const fs::path& folder : data_folders()) {
    folders.push_back(folder / "roio" / "kinds");
  }
  return folders;
}

/// What cannot be looked at is there, so that reading it says why.
bool is_there(const fs::path& file) {
  std::error_code error;
  const fs::file_type type = fs::status(file, error).type();
  return type != fs::file_type::not_found;
}

}  // namespace

KindLibrary::KindLibrary(const fs::path& robot_file, const LoadOptions& options)
    : folders_(kind_folders(robot_file, options)) {}

std::shared_ptr<const Kind> KindLibrary::get(const At& at) {
  const std::string& name = at.identifier();
  const auto known = read_.find(name);
  if (known != read_.end()) {
    return known->second;
  }
  for (const fs::path& folder : folders_) {
    const fs::path file = folder / (name + kind_suffix);
    if (!is_there(file)) {
      continue;
    }
    const Parsed<Kind> kind = load_kind(file);
    if (!kind) {
      throw Refused({kind.error().message, 0});
    }
    return read_[name] = std::make_shared<const Kind>(*kind);
  }
  refuse_unknown(at, name);
}

std::vector<std::string> KindLibrary::names() const {
  std::vector<std::string> names;
  for (const fs::path& folder : folders_) {
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
      const std::string file = entry->path().filename().string();
      if (file.ends_with(kind_suffix)) {
        names.push_back(file.substr(0, file.size() - std::string_view(kind_suffix).size()));
      }
    }
  }
  return names;
}

void KindLibrary::refuse_unknown(const At& at, const std::string& name) const {
  std::vector<std::string> folders;
  for (const fs::path& folder : folders_) {
    folders.push_back(folder.empty() ? "." : shown_name(folder.string()));
  }
  const auto near = nearest(name, names());
  at.wrong("no file " + name + kind_suffix + " in " + listed(folders) +
           (near ? "; did you mean " + quote(*near) + '?' : ""));
}

}  // namespace roio::robot_file
