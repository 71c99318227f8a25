#include "kind/names.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace roio::cli {
namespace {

using namespace std::string_view_literals;

// C++20's keywords, those of gcc, and the macros with small letters and without arguments of
// Arduino's core, avr-libc and glibc (`avr-g++ -dM -E`); sorted.
constexpr std::array keywords{
    "acosf"sv,
    "alignas"sv,
    "alignof"sv,
    "and"sv,
    "and_eq"sv,
    "asinf"sv,
    "asm"sv,
    "atan2f"sv,
    "atanf"sv,
    "auto"sv,
    "bitand"sv,
    "bitor"sv,
    "bool"sv,
    "break"sv,
    "case"sv,
    "catch"sv,
    "cbrtf"sv,
    "ceilf"sv,
    "char"sv,
    "char16_t"sv,
    "char32_t"sv,
    "char8_t"sv,
    "class"sv,
    "co_await"sv,
    "co_return"sv,
    "co_yield"sv,
    "compl"sv,
    "concept"sv,
    "const"sv,
    "const_cast"sv,
    "consteval"sv,
    "constexpr"sv,
    "constinit"sv,
    "continue"sv,
    "copysignf"sv,
    "cosf"sv,
    "coshf"sv,
    "decltype"sv,
    "default"sv,
    "delete"sv,
    "do"sv,
    "double"sv,
    "dynamic_cast"sv,
    "else"sv,
    "enum"sv,
    "errno"sv,
    "expf"sv,
    "explicit"sv,
    "export"sv,
    "extern"sv,
    "fabsf"sv,
    "false"sv,
    "fdimf"sv,
    "float"sv,
    "floorf"sv,
    "fmaf"sv,
    "fmaxf"sv,
    "fminf"sv,
    "fmodf"sv,
    "for"sv,
    "frexpf"sv,
    "friend"sv,
    "goto"sv,
    "hypotf"sv,
    "i386"sv,
    "if"sv,
    "inline"sv,
    "int"sv,
    "int16_t"sv,
    "int32_t"sv,
    "int8_t"sv,
    "isfinitef"sv,
    "isinff"sv,
    "isnanf"sv,
    "ldexpf"sv,
    "linux"sv,
    "log10f"sv,
    "logf"sv,
    "long"sv,
    "lrintf"sv,
    "lroundf"sv,
    "mutable"sv,
    "namespace"sv,
    "new"sv,
    "noexcept"sv,
    "not"sv,
    "not_eq"sv,
    "nullptr"sv,
    "operator"sv,
    "or"sv,
    "or_eq"sv,
    "powf"sv,
    "private"sv,
    "protected"sv,
    "public"sv,
    "register"sv,
    "reinterpret_cast"sv,
    "requires"sv,
    "return"sv,
    "roundf"sv,
    "short"sv,
    "signbitf"sv,
    "signed"sv,
    "sinf"sv,
    "sinhf"sv,
    "sizeof"sv,
    "squaref"sv,
    "static"sv,
    "static_assert"sv,
    "static_cast"sv,
    "stderr"sv,
    "stdin"sv,
    "stdout"sv,
    "struct"sv,
    "switch"sv,
    "tanf"sv,
    "tanhf"sv,
    "template"sv,
    "this"sv,
    "thread_local"sv,
    "throw"sv,
    "true"sv,
    "truncf"sv,
    "try"sv,
    "typedef"sv,
    "typeid"sv,
    "typename"sv,
    "typeof"sv,
    "uint16_t"sv,
    "uint32_t"sv,
    "uint8_t"sv,
    "union"sv,
    "unix"sv,
    "unsigned"sv,
    "using"sv,
    "virtual"sv,
    "void"sv,
    "volatile"sv,
    "wchar_t"sv,
    "while"sv,
    "xor"sv,
    "xor_eq"sv,
};
static_assert(std::is_sorted(keywords.begin(), keywords.end()));

// What a board's kind may well be called and has a meaning outside of all namespaces: in the C
// library, in Arduino's core, or in a sketch with Roio. Sorted.
constexpr std::array globals{
    "abs"sv,      "accept"sv, "access"sv,   "acos"sv,    "alarm"sv,   "asin"sv,     "atan"sv,
    "atoi"sv,     "bind"sv,   "boolean"sv,  "brk"sv,     "bsearch"sv, "byte"sv,     "ceil"sv,
    "chdir"sv,    "clock"sv,  "close"sv,    "connect"sv, "cos"sv,     "daylight"sv, "delay"sv,
    "div"sv,      "dup"sv,    "environ"sv,  "exit"sv,    "exp"sv,     "floor"sv,    "fork"sv,
    "free"sv,     "gamma"sv,  "index"sv,    "init"sv,    "j0"sv,      "j1"sv,       "jn"sv,
    "kill"sv,     "labs"sv,   "link"sv,     "listen"sv,  "log"sv,     "loop"sv,     "main"sv,
    "malloc"sv,   "map"sv,    "micros"sv,   "millis"sv,  "nice"sv,    "open"sv,     "pause"sv,
    "pipe"sv,     "poll"sv,   "pow"sv,      "qsort"sv,   "raise"sv,   "random"sv,   "read"sv,
    "remove"sv,   "rename"sv, "rewind"sv,   "rindex"sv,  "roio"sv,    "round"sv,    "select"sv,
    "send"sv,     "setup"sv,  "shutdown"sv, "signal"sv,  "sin"sv,     "sleep"sv,    "socket"sv,
    "sqrt"sv,     "square"sv, "std"sv,      "sync"sv,    "system"sv,  "tan"sv,      "time"sv,
    "timezone"sv, "tone"sv,   "truncate"sv, "unlink"sv,  "wait"sv,    "word"sv,     "write"sv,
    "y0"sv,       "y1"sv,     "yield"sv,    "yn"sv,
};
static_assert(std::is_sorted(globals.begin(), globals.end()));

bool is_small(char c) {
  return c >= 'a' && c <= 'z';
}
char small(char c) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}
char capital(char c) {
  return static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
}

std::string without_capitals_alone(std::string_view name) {
  std::string text(name);
  if (std::none_of(text.begin(), text.end(), is_small)) {
    std::transform(text.begin(), text.end(), text.begin(), small);
  }
  return text;
}

/// A keyword, or the name of an interrupt, as avr-libc has them: "SPI_STC_vect".
bool is_taken(std::string_view text) {
  return std::binary_search(keywords.begin(), keywords.end(), text) || text.ends_with("_vect") ||
         text.ends_with("_vect_num");
}

std::string finish(std::string text) {
  if (!text.empty() && std::isdigit(static_cast<unsigned char>(text.front())) != 0) {
    text = 'n' + text;
  }
  return is_taken(text) ? text + '_' : text;
}

}  // namespace

std::string identifier(std::string_view name) {
  std::string text;
  for (const char c : without_capitals_alone(name)) {
    const char next = c == '-' ? '_' : c;
    // Two in a row are the compiler's own.
    if (next != '_' || !text.ends_with('_')) {
      text += next;
    }
  }
  return finish(text);
}

std::string type_identifier(std::string_view name) {
  std::string text;
  bool begins = true;
  for (const char c : without_capitals_alone(name)) {
    if (c == '-' || c == '_') {
      begins = true;
      continue;
    }
    text += begins ? capital(c) : c;
    begins = false;
  }
  if (std::none_of(text.begin(), text.end(), is_small)) {
    text += '_';  // "x": capitals alone are a macro's
  }
  return finish(text);
}

std::string global_identifier(std::string_view name) {
  std::string text = identifier(name);
  // With a capital: classes and objects of Arduino's core and of its libraries, "Servo", "Serial".
  const bool is_known = std::isupper(static_cast<unsigned char>(text.front())) != 0 ||
                        std::binary_search(globals.begin(), globals.end(), text);
  return is_known ? text + '_' : text;
}

std::string Scope::add(const std::string& wanted, std::size_t longest) {
  std::string name = wanted.substr(0, longest);
  for (int number = 2; !taken_.insert(name).second; ++number) {
    const std::string suffix = '_' + std::to_string(number);
    name = wanted.substr(0, longest - suffix.size()) + suffix;
  }
  return name;
}

}  // namespace roio::cli
