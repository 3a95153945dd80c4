// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Which box belongs to which track: the assignment of least total cost (Kuhn 1955, Munkres 1957).
#pragma once

#include <cstddef>
#include <vector>

namespace lidar_obstacles {

/// Pairs rows with columns, group by group of those that may want the same: most tracks have few boxes near them, and
/// the work grows with the cube. Keeps its working memory from call to call.
class Assignment {
  public:
    /// @param costs  rows x columns, row-major.
    /// @param limit  a pair that costs as much or more is none; a row that stays alone costs as much.
    /// @return the column of each row, -1 where it has none; valid until the next call.
    const std::vector<int>& solve(const std::vector<double>& costs, std::size_t rows, std::size_t columns,
                                  double limit);

  private:
    std::size_t rootOf(std::size_t row) const;
    void findGroups(const std::vector<double>& costs, std::size_t rows, std::size_t columns);
    void solveGroup(const std::vector<double>& costs, std::size_t columns, std::size_t group);
    void augment(std::size_t row);
    std::size_t nextColumn(std::size_t column);
    double cost(std::size_t row, std::size_t column) const;

    double limit_ = 0.0;
    std::vector<std::size_t> group_of_;   ///< of each row: the first row of its group
    std::vector<std::size_t> first_row_;  ///< of each column: the first that may want it; the number of rows: none
    std::vector<std::size_t> own_rows_, own_columns_;  ///< of the group at hand
    std::vector<double> own_costs_;
    std::vector<double> row_price_, column_price_, slack_;
    std::vector<std::size_t> row_of_, from_;
    std::vector<unsigned char> done_;
    std::vector<int> column_of_;
};

}  // namespace lidar_obstacles
