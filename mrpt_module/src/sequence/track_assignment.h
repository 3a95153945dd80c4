// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Which box belongs to which track: the assignment of least total cost (Kuhn 1955, Munkres 1957).
#pragma once

#include <cstddef>
#include <vector>

namespace lidar_obstacles {

/// Pairs rows with columns. Keeps its working memory from call to call.
class Assignment {
  public:
    /// @param costs  rows x columns, row-major.
    /// @param limit  a pair that costs as much or more is none; a row that stays alone costs as much.
    /// @return the column of each row, -1 where it has none; valid until the next call.
    const std::vector<int>& solve(const std::vector<double>& costs, std::size_t rows, std::size_t columns,
                                  double limit);

  private:
    void augment(std::size_t row);
    std::size_t nextColumn(std::size_t column);
    double cost(std::size_t row, std::size_t column) const;

    const std::vector<double>* costs_ = nullptr;
    std::size_t rows_ = 0;
    std::size_t columns_ = 0;
    double limit_ = 0.0;
    std::vector<double> row_price_, column_price_, slack_;
    std::vector<std::size_t> row_of_, from_;
    std::vector<unsigned char> done_;
    std::vector<int> column_of_;
};

}  // namespace lidar_obstacles
