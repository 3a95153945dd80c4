// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Reading the small files of a data set, with file and line in every complaint.
#pragma once

#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace lidar_obstacles::apps {

/// All lines of a file, without line ends. @throws std::runtime_error if it cannot be read.
std::vector<std::string> linesOf(const std::filesystem::path& file);

/// A line of words, separated by blanks.
class Words {
  public:
    Words(std::filesystem::path file, std::size_t line, const std::string& text);

    std::size_t size() const { return words_.size(); }
    const std::string& text(std::size_t k) const;
    /// @throws std::runtime_error "FILE:LINE: word K 'abc' is not a number".
    double number(std::size_t k) const;
    int integer(std::size_t k) const;
    [[noreturn]] void fail(const std::string& what) const;

  private:
    std::filesystem::path file_;
    std::size_t line_;
    std::vector<std::string> words_;
};

/// The lines of a file as words; empty lines are left out.
std::vector<Words> wordsOf(const std::filesystem::path& file);

/// The same with the empty lines: for files in which the number of a line is that of a scan.
std::vector<Words> rowsOf(const std::filesystem::path& file);

/// Files of a folder with this extension, by name. @throws std::runtime_error if there is no such folder.
std::vector<std::filesystem::path> filesIn(const std::filesystem::path& folder, const std::string& extension);

}  // namespace lidar_obstacles::apps
