#include "cli/pages/roff.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace ist::cli {
namespace {

constexpr std::size_t kColumns = 76;  // of the source; the terminal decides what a reader sees

std::string quoted(const std::string& words) { return "\"" + plain(words) + "\""; }

// An option in bold, without the brackets and the stop around it.
std::string with_option_bold(const std::string& word) {
  const std::size_t begin = word.find("--");
  if (begin == word.npos || word.find_first_not_of("(/") != begin) return plain(word);
  const std::size_t end =
      std::min(word.find_first_not_of("abcdefghijklmnopqrstuvwxyz-", begin), word.size());
  return plain(word.substr(0, begin)) + bold(word.substr(begin, end - begin)) +
         plain(word.substr(end));
}

}  // namespace

std::string plain(std::string_view words) {
  std::string roff;
  for (const char c : words) {
    switch (c) {
      case '\\':
        roff += "\\e";
        break;
      case '-':
        roff += "\\-";  // a plain one may become a hyphen, which no shell reads as an option's
        break;
      case '\'':
        roff += "\\(aq";
        break;
      case '"':
        roff += "\\(dq";
        break;
      case '~':
        roff += "\\(ti";
        break;
      case '^':
        roff += "\\(ha";
        break;
      case '`':
        roff += "\\(ga";
        break;
      default:
        roff += c;
    }
  }
  return roff;
}

std::string bold(std::string_view words) { return "\\fB" + plain(words) + "\\fR"; }
std::string italic(std::string_view words) { return "\\fI" + plain(words) + "\\fR"; }

Roff::Roff(const std::string& name, const std::string& date, const std::string& version) {
  line(fmt::format(".TH {} 1 {} {} {}", quoted(name), date, quoted(version),
                   quoted("Implicit Sphere Tree")));
}

void Roff::section(const std::string& title) { line(".SH " + quoted(title)); }
void Roff::subsection(const std::string& title) { line(".SS " + quoted(title)); }
void Roff::line(const std::string& roff) { text_ += roff + "\n"; }

void Roff::entry(const std::string& roff) {
  line(".TP");
  line(roff);
}

void Roff::paragraph(const std::string& text) {
  line(".PP");
  fill(text);
}

void Roff::fill(const std::string& text) {
  std::istringstream words(text);
  std::string row;
  for (std::string word; words >> word;) {
    const std::string roff = with_option_bold(word);
    if (!row.empty() && row.size() + roff.size() >= kColumns) {
      line(row);
      row.clear();
    }
    // A line that begins with a full stop would be a request.
    row += row.empty() ? (word.front() == '.' ? "\\&" : "") : " ";
    row += roff;
    if (word.back() == '.') {  // roff spaces sentences by the ends of lines
      line(row);
      row.clear();
    }
  }
  if (!row.empty()) line(row);
}

void Roff::literal(const std::string& text) {
  line(".EX");
  line(plain(text));
  line(".EE");
}

}  // namespace ist::cli
