// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Strict reading of CSV files with a header: no quotes, no missing cells.
#pragma once

#include <cstddef>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace lidar_obstacles::evaluation {

/// Rows of a CSV file, one after another. Errors are CsvError with file, line, column and what was expected.
/// An object is for one thread at a time.
class CsvReader {
  public:
    /// Opens the file and reads its header.
    /// @throws CsvError if a required column is missing or any is named twice; std::runtime_error if it cannot be read.
    CsvReader(std::string file, const std::vector<std::string>& required);

    /// Goes to the next row; false at the end. Empty lines are skipped.
    bool next();

    bool has(const std::string& column) const { return columns_.count(column) != 0; }
    const std::string& text(const std::string& column) const;
    std::string lowerText(const std::string& column) const;
    double number(const std::string& column) const;
    int integer(const std::string& column) const;
    /// A number, or NaN where the cell is empty or "nan".
    double numberOrNan(const std::string& column) const;
    double nonNegative(const std::string& column) const;
    bool flag(const std::string& column) const;

    [[noreturn]] void fail(const std::string& what) const;

  private:
    std::string file_;
    std::ifstream in_;
    std::map<std::string, std::size_t> columns_;
    std::vector<std::string> cells_;
    std::size_t line_ = 0;
};

}  // namespace lidar_obstacles::evaluation
