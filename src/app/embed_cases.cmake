# cmake -DCASE_DIR=<folder> -DOUTPUT=<file.cpp> -P embed_cases.cmake
#
# Writes a C++ file that holds the text of every file below the folder, so that `squall validate` reads nothing from the
# source tree at run time.

cmake_minimum_required(VERSION 3.25)
include("${CMAKE_CURRENT_LIST_DIR}/../../cmake/quote_text.cmake")

file(GLOB_RECURSE files RELATIVE "${CASE_DIR}" "${CASE_DIR}/*.toml" "${CASE_DIR}/*.csv")
list(SORT files)
set(code "// Written by embed_cases.cmake.\n#include \"app/builtin_cases.h\"\n\n")
string(APPEND code "namespace squall::app {\n\nusing namespace std::string_literals;\n\nconst std::map<std::string, std::string>& embedded_case_files() {\n")
string(APPEND code "  static const std::map<std::string, std::string> files{\n")
foreach(name IN LISTS files)
  file(READ "${CASE_DIR}/${name}" text)
  quote_text("${text}" quoted)
  string(APPEND code "      {\"${name}\", ${quoted}},\n")
endforeach()
string(APPEND code "  };\n  return files;\n}\n\n}  // namespace squall::app\n")
file(WRITE "${OUTPUT}" "${code}")
