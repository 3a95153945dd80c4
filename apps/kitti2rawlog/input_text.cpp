// SPDX-License-Identifier: BSD-3-Clause
#include "input_text.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

namespace lidar_obstacles::apps {

namespace fs = std::filesystem;

std::vector<std::string> linesOf(const fs::path& file) {
    std::ifstream in(file);
    if (!in) throw std::runtime_error(file.string() + ": cannot read: " + std::strerror(errno));
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);) {
        if (!line.empty() && line.back() == '\r') line.pop_back();
        lines.push_back(line);
    }
    return lines;
}

Words::Words(fs::path file, std::size_t line, const std::string& text) : file_(std::move(file)), line_(line) {
    std::istringstream in(text);
    for (std::string word; in >> word;) words_.push_back(word);
}

const std::string& Words::text(std::size_t k) const {
    if (k >= words_.size())
        fail("only " + std::to_string(words_.size()) + " words, expected at least " + std::to_string(k + 1));
    return words_[k];
}

double Words::number(std::size_t k) const {
    const std::string& word = text(k);
    const char* begin = word.data() + (word.front() == '+' ? 1 : 0);  // std::from_chars knows no plus sign
    double value = 0.0;
    const auto [end, error] = std::from_chars(begin, word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
        fail("word " + std::to_string(k + 1) + " '" + word + "' is not a number");
    return value;
}

int Words::integer(std::size_t k) const {
    const double value = number(k);
    if (value != std::floor(value) || std::abs(value) > 1e9)
        fail("word " + std::to_string(k + 1) + " '" + text(k) + "' is not a whole number");
    return static_cast<int>(value);
}

void Words::fail(const std::string& what) const {
    throw std::runtime_error(file_.string() + ':' + std::to_string(line_) + ": " + what);
}

std::vector<Words> rowsOf(const fs::path& file) {
    std::vector<Words> all;
    std::size_t line = 0;
    for (const std::string& text : linesOf(file)) all.emplace_back(file, ++line, text);
    return all;
}

std::vector<Words> wordsOf(const fs::path& file) {
    std::vector<Words> all = rowsOf(file);
    all.erase(std::remove_if(all.begin(), all.end(), [](const Words& row) { return row.size() == 0; }), all.end());
    return all;
}

std::vector<fs::path> filesIn(const fs::path& folder, const std::string& extension) {
    if (!fs::is_directory(folder)) throw std::runtime_error(folder.string() + ": no such folder");
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.path().extension() == extension) files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace lidar_obstacles::apps
