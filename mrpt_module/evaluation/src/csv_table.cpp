// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/evaluation/csv_table.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "lidar_obstacles/evaluation/truth.h"

namespace lidar_obstacles::evaluation {
namespace {

std::string trimmed(const std::string& text) {
    const auto begin = text.find_first_not_of(" \t\r");
    if (begin == std::string::npos) return "";
    return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

std::vector<std::string> cellsOf(const std::string& line) {
    std::vector<std::string> cells;
    std::size_t begin = 0;
    for (std::size_t comma = line.find(','); comma != std::string::npos; comma = line.find(',', begin)) {
        cells.push_back(trimmed(line.substr(begin, comma - begin)));
        begin = comma + 1;
    }
    cells.push_back(trimmed(line.substr(begin)));
    return cells;
}

/// A finite number that is the whole text.
bool parse(const std::string& text, double& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

}  // namespace

CsvReader::CsvReader(std::string file, const std::vector<std::string>& required) : file_(std::move(file)), in_(file_) {
    if (!in_) throw std::runtime_error(file_ + ": cannot read: " + std::strerror(errno));
    if (!next()) throw CsvError(file_ + ": no header: expected a line with the names of the columns");
    for (std::size_t k = 0; k < cells_.size(); ++k) {
        if (!columns_.emplace(cells_[k], k).second) fail("column '" + cells_[k] + "' is named twice");
    }
    for (const std::string& column : required) {
        if (!has(column)) fail("no column '" + column + "' in the header");
    }
}

bool CsvReader::next() {
    std::string line;
    do {
        if (!std::getline(in_, line)) {
            if (in_.bad()) throw std::runtime_error(file_ + ": cannot read: " + std::strerror(errno));
            return false;
        }
        ++line_;
    } while (trimmed(line).empty());
    cells_ = cellsOf(line);
    if (!columns_.empty() && cells_.size() != columns_.size()) {
        fail(std::to_string(cells_.size()) + " cells, expected " + std::to_string(columns_.size()) +
             " as in the header");
    }
    return true;
}

const std::string& CsvReader::text(const std::string& column) const { return cells_[columns_.at(column)]; }

std::string CsvReader::lowerText(const std::string& column) const {
    std::string word = text(column);
    if (word.empty()) fail(column + ": empty, expected a word");
    std::transform(word.begin(), word.end(), word.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return word;
}

double CsvReader::number(const std::string& column) const {
    double value = 0.0;
    if (!parse(text(column), value)) fail(column + ": '" + text(column) + "' is not a number");
    return value;
}

int CsvReader::integer(const std::string& column) const {
    const double value = number(column);
    if (value != std::floor(value) || std::abs(value) > std::numeric_limits<int>::max()) {
        fail(column + ": '" + text(column) + "' is not a whole number");
    }
    return static_cast<int>(value);
}

double CsvReader::numberOrNan(const std::string& column) const {
    const std::string& word = text(column);
    return word.empty() || word == "nan" ? std::numeric_limits<double>::quiet_NaN() : number(column);
}

double CsvReader::nonNegative(const std::string& column) const {
    const double value = number(column);
    if (value < 0.0) fail(column + ": '" + text(column) + "' is negative");
    return value;
}

bool CsvReader::flag(const std::string& column) const {
    const std::string& word = text(column);
    if (word != "0" && word != "1") fail(column + ": '" + word + "' is neither 0 nor 1");
    return word == "1";
}

void CsvReader::fail(const std::string& what) const {
    throw CsvError(file_ + ":" + std::to_string(line_) + ": " + what);
}

}  // namespace lidar_obstacles::evaluation
