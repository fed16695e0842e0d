# quote_text(<text> <variable>): the text as a C++ expression of type std::string. No compiler needs to take a literal of more
# than 65,536 characters, so it comes in pieces of whole lines. Wants `using namespace std::string_literals;`.
function(quote_text text result)
  set(pieces "")
  string(LENGTH "${text}" left)
  while(left GREATER 32000)
    string(SUBSTRING "${text}" 0 32000 piece)
    string(FIND "${piece}" "\n" end REVERSE)
    math(EXPR end "${end} + 1")
    if(end EQUAL 0)  # one endless line
      set(end 32000)
    endif()
    string(SUBSTRING "${text}" 0 ${end} piece)
    string(SUBSTRING "${text}" ${end} -1 text)
    string(APPEND pieces "R\"squall(${piece})squall\"s + ")
    string(LENGTH "${text}" left)
  endwhile()
  set(${result} "${pieces}R\"squall(${text})squall\"s" PARENT_SCOPE)
endfunction()
