// SPDX-License-Identifier: MIT
#include "root_sph/io/csv_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include "root_sph/core/errors.hpp"
#include "root_sph/io/files.hpp"

namespace rootsoil {
namespace {

// The CSV libraries at hand (Fast C++ CSV Parser, libcsv) want column titles byte by byte as expected or leave
// lines uncounted. Titles with any bytes for the micro sign, a list of all missing ones, and line numbers need
// the header taken apart here; splitting the rows in the same way is then all that is left.
std::vector<std::string_view> split(std::string_view line, char separator) {
  std::vector<std::string_view> values;
  while (true) {
    const std::size_t first = line.find_first_not_of(separator == '\t' ? " " : " \t");
    const bool quoted = first != std::string_view::npos && line[first] == '"';
    const std::size_t closing = quoted ? line.find('"', first + 1) : 0;
    const std::size_t end = closing == std::string_view::npos ? closing : line.find(separator, closing);
    std::string_view value = line.substr(0, end);
    const auto is_padding = [](char c) { return c == ' ' || c == '\t' || c == '"'; };
    while (!value.empty() && is_padding(value.front())) value.remove_prefix(1);
    while (!value.empty() && is_padding(value.back())) value.remove_suffix(1);
    values.push_back(value);
    if (end == std::string_view::npos) return values;
    line.remove_prefix(end + 1);
  }
}

// The one that a header holds most often.
char separator_of(std::string_view header) {
  char best = ',';
  for (const char c : {';', '\t'}) {
    if (std::count(header.begin(), header.end(), c) > std::count(header.begin(), header.end(), best)) best = c;
  }
  return best;
}

// "pos.X (?m)" with any bytes but a letter or digit for "?" becomes "pos.X(um)", spaces aside; "(mm)" stays.
std::string plain_title(std::string_view title) {
  std::string plain;
  for (const char c : title) {
    if (c != ' ' && c != '\t') plain += c;
  }
  const auto is_alphanumeric = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  };
  const std::size_t open = plain.find('(');
  if (open == std::string::npos || !plain.ends_with("m)")) return plain;
  const std::string_view sign = std::string_view(plain).substr(open + 1, plain.size() - open - 3);
  if (sign.empty() || std::any_of(sign.begin(), sign.end(), is_alphanumeric)) return plain;
  return plain.substr(0, open) + "(um)";
}

// For messages: broken bytes would break the terminal or the log as well.
std::string printable(std::string_view text) {
  constexpr std::size_t longest = 200;
  std::string plain(text.substr(0, longest));
  std::replace_if(
      plain.begin(), plain.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return plain + (text.size() > longest ? "..." : "");
}

}  // namespace

CsvReader::CsvReader(std::string_view text, std::string name, const CsvTable& table)
    : rest_(text), name_(std::move(name)), table_(table), place_(table.columns.size()) {
  if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);
  read_header();
}

void CsvReader::fail(std::string key, std::string what, std::string given, std::string allowed,
                     std::string remedy) const {
  throw InputError(
      {name_, line_number_, std::move(key), std::move(what), std::move(given), std::move(allowed), std::move(remedy)});
}

void CsvReader::fail_at(std::size_t column, std::string what, std::string given, std::string allowed) const {
  fail_at(column, std::move(what), std::move(given), std::move(allowed), table_.row_remedy);
}

void CsvReader::fail_at(std::size_t column, std::string what, std::string given, std::string allowed,
                        std::string remedy) const {
  fail(fmt::format("column '{}'", table_.columns[column]), std::move(what), std::move(given), std::move(allowed),
       std::move(remedy));
}

// Skips empty lines; false at the end.
bool CsvReader::next_line() {
  while (!rest_.empty()) {
    const std::size_t end = rest_.find('\n');
    line_ = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++line_number_;
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    if (line_.find_first_not_of(" \t\r") != std::string_view::npos) return true;
  }
  return false;
}

void CsvReader::read_header() {
  const std::string columns = fmt::format("{}", fmt::join(table_.columns, ", "));
  if (!next_line()) {
    line_number_ = 0;
    fail({}, "the file is empty", {}, "a header: " + columns, table_.whole_remedy);
  }
  separator_ = separator_of(line_);
  const std::vector<std::string_view> titles = split(line_, separator_);
  width_ = titles.size();
  std::vector<std::string_view> missing;
  for (std::size_t column = 0; column < place_.size(); ++column) {
    const std::string wanted = plain_title(table_.columns[column]);
    const auto is_wanted = [&](std::string_view title) { return plain_title(title) == wanted; };
    const auto found = std::find_if(titles.begin(), titles.end(), is_wanted);
    if (found == titles.end()) {
      missing.push_back(table_.columns[column]);
      continue;
    }
    if (std::find_if(found + 1, titles.end(), is_wanted) != titles.end()) {
      fail_at(column, "the column is there twice", printable(line_), "every column once", "remove one of them");
    }
    place_[column] = static_cast<std::size_t>(found - titles.begin());
  }
  if (!missing.empty()) {
    fail({}, fmt::format("columns are missing: {}", fmt::join(missing, ", ")), printable(line_),
         fmt::format("a header with {}, separated by commas, semicolons or tabs, in any order", columns),
         table_.header_remedy);
  }
}

bool CsvReader::next_row() {
  if (!next_line()) {
    if (rows_ > 0) return false;
    line_number_ = 0;
    fail({}, fmt::format("the file holds no {}", table_.rows), "a header and no rows", "one row or more",
         table_.whole_remedy);
  }
  ++rows_;
  values_ = split(line_, separator_);
  const auto beyond = values_.begin() + static_cast<std::ptrdiff_t>(std::min(width_, values_.size()));
  if (std::any_of(beyond, values_.end(), [](std::string_view value) { return !value.empty(); })) {
    fail({}, "the row has more values than the header has columns", fmt::format("{} values", values_.size()),
         fmt::format("{} values", width_),
         separator_ == ',' ? "write numbers with a decimal point, or separate them by semicolons" : table_.row_remedy);
  }
  return true;
}

// A comma separates decimals where it does not separate values. Points for thousands would make numbers a thousandfold
// too small, so a table has one sign or the other.
std::string CsvReader::with_decimal_point(std::size_t column, std::string_view text) const {
  std::string number(text);
  const std::size_t sign = number.find_first_of(".,");
  if (sign == std::string::npos) return number;
  if (decimal_sign_ == 0) decimal_sign_ = number[sign];
  if (number.find_first_of(".,", sign + 1) != std::string::npos || number[sign] != decimal_sign_) {
    fail_at(column, "points and commas are mixed", printable(text), "numbers such as 1234.5, or all such as 1234,5",
            "write numbers without a sign for thousands");
  }
  number[sign] = '.';
  return number;
}

double CsvReader::number(std::size_t column) const {
  if (place_[column] >= values_.size() || values_[place_[column]].empty()) {
    fail_at(column, "the value is missing", fmt::format("a row of {} values", values_.size()),
            fmt::format("{} values, as in the header", width_));
  }
  const std::string given = printable(values_[place_[column]]);
  const std::string plain = with_decimal_point(column, values_[place_[column]]);
  std::string_view text = plain;
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size() || error == std::errc::invalid_argument) {
    fail_at(column, "not a number", given, "a number such as 12.5 or 1.25e1");
  }
  if (error == std::errc::result_out_of_range || !std::isfinite(value)) {
    fail_at(column, "not a finite number, or beyond what a number can hold", given, "a finite number");
  }
  return value;
}

std::vector<std::string> csv_titles(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  const std::string_view header = text.substr(0, text.find_first_of("\r\n"));
  std::vector<std::string> titles;
  for (const std::string_view title : split(header, separator_of(header))) titles.emplace_back(title);
  return titles;
}

bool holds_title(const std::vector<std::string>& titles, std::string_view wanted) {
  return std::any_of(titles.begin(), titles.end(),
                     [plain = plain_title(wanted)](const std::string& title) { return plain_title(title) == plain; });
}

std::string read_users_file(const std::filesystem::path& path, const std::string& key, const std::string& allowed) {
  std::error_code trouble;
  if (!std::filesystem::is_regular_file(path, trouble)) {
    throw InputError({.file = path.string(),
                      .key = key,
                      .what = "there is no such file",
                      .given = path.string(),
                      .allowed = allowed,
                      .remedy = "correct the path; a relative one starts at the scene file's folder"});
  }
  return read_whole_file(path);
}

}  // namespace rootsoil
