#include "avr/image.hpp"

#include <elf.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string_view>

namespace roio::sim {
namespace {

// Where avr-gcc's linker puts what is not flash.
constexpr std::uint32_t eeprom_base = 0x81'0000;
constexpr std::uint32_t data_base = 0x80'0000;
constexpr std::uint32_t eeprom_end = 0x82'0000;
constexpr std::uint32_t largest_flash = 0x4'0000;
constexpr std::uint32_t architecture_mask = 0x7F;
// The name stands at the end of the note that avr-libc's start-up code leaves.
constexpr const char* device_section = ".note.gnu.avr.deviceinfo";

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : path_(path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) {
      fail("cannot be opened");
    }
    bytes_.assign(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    if (file.bad()) {
      fail("cannot be read");
    }
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(path_.string() + ": " + what);
  }

  [[nodiscard]] bool begins_with(std::string_view text) const {
    return text.size() <= bytes_.size() && std::equal(text.begin(), text.end(), bytes_.begin());
  }

  template <class T>
  [[nodiscard]] T at(std::size_t offset) const {
    T value{};
    std::memcpy(&value, range(offset, sizeof value), sizeof value);
    return value;
  }

  [[nodiscard]] const char* range(std::size_t offset, std::size_t length) const {
    if (offset > bytes_.size() || length > bytes_.size() - offset) {
      fail("ends too early");
    }
    return bytes_.data() + offset;
  }

  [[nodiscard]] std::string text(std::size_t offset, std::size_t length) const {
    const char* const begin = range(offset, length);
    return {begin, std::find(begin, begin + length, '\0')};
  }

 private:
  std::filesystem::path path_;
  std::vector<char> bytes_;
};

Elf32_Ehdr read_header(const Reader& file) {
  if (!file.begins_with({ELFMAG, SELFMAG})) {
    file.fail("is not an ELF file");
  }
  const auto header = file.at<Elf32_Ehdr>(0);
  if (header.e_ident[EI_CLASS] != ELFCLASS32 || header.e_machine != EM_AVR) {
    file.fail("is not a program for an AVR");
  }
  if (header.e_type != ET_EXEC) {
    file.fail("is not a whole program, but has still to be linked");
  }
  return header;
}

void place(std::vector<std::uint8_t>& memory, std::size_t address, const char* begin,
           std::size_t length) {
  memory.resize(std::max(memory.size(), address + length), 0xFF);
  std::copy_n(begin, length, memory.begin() + static_cast<std::ptrdiff_t>(address));
}

void read_segments(const Reader& file, const Elf32_Ehdr& header, AvrImage& image) {
  for (unsigned i = 0; i < header.e_phnum; ++i) {
    const auto segment = file.at<Elf32_Phdr>(header.e_phoff + std::size_t{i} * header.e_phentsize);
    if (segment.p_type != PT_LOAD || segment.p_filesz == 0) {
      continue;
    }
    const char* const begin = file.range(segment.p_offset, segment.p_filesz);
    const std::uint32_t address = segment.p_paddr;
    if (address < largest_flash && segment.p_filesz <= largest_flash) {
      place(image.flash, address, begin, segment.p_filesz);
    } else if (address < data_base) {
      file.fail("has something beyond any AVR's flash");
    } else if (address >= eeprom_base && address < eeprom_end) {
      place(image.eeprom, address - eeprom_base, begin, segment.p_filesz);
    }
    // What lies above are fuses, lock bits and signature.
  }
}

std::string read_device(const Reader& file, const Elf32_Ehdr& header) {
  if (header.e_shnum == 0) {
    return {};
  }
  const auto section_at = [&](std::size_t index) {
    return file.at<Elf32_Shdr>(header.e_shoff + index * header.e_shentsize);
  };
  const Elf32_Shdr names = section_at(header.e_shstrndx);
  for (unsigned i = 0; i < header.e_shnum; ++i) {
    const Elf32_Shdr section = section_at(i);
    if (section.sh_name < names.sh_size &&
        file.text(names.sh_offset + section.sh_name, names.sh_size - section.sh_name) ==
            device_section) {
      // A header of 16 bytes, a table of 8 words and one byte, then the name.
      const std::string note(file.range(section.sh_offset, section.sh_size), section.sh_size);
      const std::size_t begin = note.find("at", 16);
      return begin == std::string::npos ? std::string() : std::string(note.c_str() + begin);
    }
  }
  return {};
}

}  // namespace

AvrImage read_avr_image(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) {
    throw std::runtime_error(path.string() + ": no such file");
  }
  if (!std::filesystem::is_regular_file(path)) {
    throw std::runtime_error(path.string() + ": is not a file");
  }
  const Reader file(path);
  const Elf32_Ehdr header = read_header(file);
  AvrImage image;
  image.architecture = header.e_flags & architecture_mask;
  read_segments(file, header, image);
  image.mcu = read_device(file, header);
  if (image.flash.empty()) {
    file.fail("holds no program");
  }
  return image;
}

}  // namespace roio::sim
