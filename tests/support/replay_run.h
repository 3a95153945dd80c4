// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// obstacle-replay, run for a test, and the rows of the obstacles.csv it wrote.
#pragma once

#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

#include "support/shell.h"
#include "support/temp_folder.h"

namespace lidar_obstacles::test {

struct CsvRow {
    std::size_t scan;
    std::vector<std::string> fields;
    double at(int column) const { return std::stod(fields[static_cast<std::size_t>(column)]); }
};

/// Runs `program` (obstacle-replay) with its results in `file("out")`.
class ReplayRun {
  public:
    int run(const std::string& program, const std::string& arguments, const std::string& before = "") const {
        return shell(before + " '" + program + "' " + arguments + " --output '" + file("out") + "' >'" +
                     file("stdout") + "' 2>'" + file("stderr") + "'");
    }
    std::string file(const std::string& name) const { return folder_.file(name); }
    std::string err() const { return readFile(file("stderr")); }

    std::vector<CsvRow> csv(std::size_t scan) const {
        std::istringstream in(readFile(file("out/obstacles.csv")));
        std::string line;
        std::getline(in, line);
        std::vector<CsvRow> rows;
        while (std::getline(in, line)) {
            CsvRow row;
            std::istringstream cells(line);
            for (std::string cell; std::getline(cells, cell, ',');) row.fields.push_back(cell);
            row.scan = std::stoul(row.fields[1]);
            if (row.scan == scan) rows.push_back(row);
        }
        return rows;
    }

  private:
    TempFolder folder_;
};

}  // namespace lidar_obstacles::test
