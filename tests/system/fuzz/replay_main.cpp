// Stands in for libFuzzer in the ordinary tests: gives a target every file of its corpus and then
// inputs made of them by random changes. Usage: fuzz_NAME CORPUS_FOLDER
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "seed.hpp"
#include "target.hpp"

namespace {

using roio::test::up_to;
using Input = std::string;

constexpr int changed_inputs = 20000;
constexpr std::size_t longest_input = 8192;

std::vector<Input> read_corpus(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    paths.push_back(entry.path());
  }
  std::sort(paths.begin(),
            paths.end());  // the same order everywhere, so that a seed means the same
  std::vector<Input> corpus;
  for (const auto& path : paths) {
    std::ifstream file(path, std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return corpus;
}

std::size_t random_place(std::mt19937& generator, const Input& input) {
  return up_to(generator, static_cast<std::uint32_t>(input.size()));
}

Input random_part(std::mt19937& generator, const Input& input) {
  const std::size_t start = random_place(generator, input);
  return input.substr(start, 1 + up_to(generator, 15));
}

// Half of the characters put in come from another seed, as those mean something to the parser.
Input random_text(std::mt19937& generator, const std::vector<Input>& corpus) {
  if (up_to(generator, 1) == 0) {
    return random_part(generator,
                       corpus[up_to(generator, static_cast<std::uint32_t>(corpus.size() - 1))]);
  }
  return {static_cast<char>(up_to(generator, 0xFF))};
}

void change(std::mt19937& generator, const std::vector<Input>& corpus, Input& input) {
  const std::size_t place = random_place(generator, input);
  switch (up_to(generator, 4)) {
    case 0:
      input.insert(place, random_text(generator, corpus));
      break;
    case 1:
      input.erase(place, 1 + up_to(generator, 7));
      break;
    case 2:
      input.replace(place, 1, random_text(generator, corpus));
      break;
    case 3:
      if (place < input.size()) {
        input[place] = static_cast<char>(input[place] ^ (1 << up_to(generator, 7)));
      }
      break;
    default:
      input += input.substr(place);
      break;
  }
  input.resize(std::min(input.size(), longest_input));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: " << argv[0] << " CORPUS_FOLDER\n";
    return 2;
  }
  const std::vector<Input> corpus = read_corpus(argv[1]);
  if (corpus.empty()) {
    std::cerr << argv[1] << ": no seeds; expected at least one file\n";
    return 2;
  }
  std::for_each(corpus.begin(), corpus.end(), roio::fuzz::check);
  std::mt19937 generator = roio::test::seeded_generator();
  std::cout.flush();  // an input that ends the program must not take its seed along
  for (int i = 0; i < changed_inputs; ++i) {
    Input input = corpus[up_to(generator, static_cast<std::uint32_t>(corpus.size() - 1))];
    for (std::uint32_t changes = 1 + up_to(generator, 3); changes > 0; --changes) {
      change(generator, corpus, input);
    }
    roio::fuzz::check(input);
  }
  std::cout << corpus.size() << " seeds and " << changed_inputs << " changed inputs\n";
  return 0;
}
