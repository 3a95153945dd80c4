// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Files of results as tables of a database.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "database.h"

namespace lidar_obstacles::fleet {

/// Makes a table with the column `result` and those of the header of a CSV file, each of the type its name has.
void createTable(Database& database, const std::string& table, const std::string& header);

/// Appends the rows of a file to a table of createTable(), with the number of the result; empty cells are NULL.
/// @return how many rows.
/// @throws std::runtime_error naming file, line and what was expected.
class RowInserter {
  public:
    /// @param header  as createTable() had it.
    RowInserter(const Database& database, const std::string& table, std::string header);
    std::size_t add(const std::filesystem::path& file, std::int64_t result);

  private:
    void bindRow(const std::string& line, const std::string& place);

    std::string header_;
    std::string kinds_;  ///< 't', 'i' or 'r' for each column
    Statement insert_;
};

}  // namespace lidar_obstacles::fleet
