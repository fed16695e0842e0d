// Command lines, one argument a line: options or a UsageError, whatever is typed.
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <string>
#include <vector>

#include "app/exit_codes.h"
#include "app/option_parser.h"

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  std::cout.setstate(std::ios::failbit);  // help texts and notes
  std::cerr.setstate(std::ios::failbit);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::string> texts{"squall"};
  std::string text;
  for (std::size_t i = 0; i < size; ++i) {
    const char c = static_cast<char>(data[i]);
    if (c == '\0') return 0;  // ends an argument
    if (c != '\n') text += c;
    if (c != '\n' && i + 1 < size) continue;
    texts.push_back(text);
    text.clear();
  }
  std::vector<char*> arguments;
  for (auto& one : texts) arguments.push_back(one.data());
  arguments.push_back(nullptr);
  try {
    static_cast<void>(squall::app::parse_options(static_cast<int>(texts.size()), arguments.data()));
  } catch (const squall::app::UsageError&) {
  }
  return 0;
}
