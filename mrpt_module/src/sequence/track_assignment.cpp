// SPDX-License-Identifier: BSD-3-Clause
#include "sequence/track_assignment.h"

#include <algorithm>
#include <limits>

namespace lidar_obstacles {

/// Columns beyond the real ones stand for "none": each row has one of its own choice at the limit.
double Assignment::cost(std::size_t row, std::size_t column) const {
    return column < columns_ ? std::min(limit_, (*costs_)[row * columns_ + column]) : limit_;
}

const std::vector<int>& Assignment::solve(const std::vector<double>& costs, std::size_t rows, std::size_t columns,
                                          double limit) {
    costs_ = &costs;
    rows_ = rows;
    columns_ = columns;
    limit_ = limit;
    const std::size_t all = columns + rows;
    row_price_.assign(rows + 1, 0.0);
    column_price_.assign(all + 1, 0.0);
    row_of_.assign(all + 1, 0);
    from_.assign(all + 1, 0);
    for (std::size_t row = 1; row <= rows; ++row) augment(row);
    column_of_.assign(rows, -1);
    for (std::size_t column = 1; column <= columns; ++column) {
        if (row_of_[column] == 0) continue;
        const std::size_t row = row_of_[column] - 1;
        if (costs[row * columns + column - 1] < limit) column_of_[row] = static_cast<int>(column - 1);
    }
    return column_of_;
}

/// One step of the path: from a column that is done to the nearest one that is not; the prices follow.
std::size_t Assignment::nextColumn(std::size_t column) {
    const std::size_t all = columns_ + rows_;
    const std::size_t at = row_of_[column];
    done_[column] = 1;
    std::size_t next = 0;
    double step = std::numeric_limits<double>::infinity();
    for (std::size_t j = 1; j <= all; ++j) {
        if (done_[j] != 0) continue;
        const double reduced = cost(at - 1, j - 1) - row_price_[at] - column_price_[j];
        if (reduced < slack_[j]) {
            slack_[j] = reduced;
            from_[j] = column;
        }
        if (slack_[j] < step) {
            step = slack_[j];
            next = j;
        }
    }
    for (std::size_t j = 0; j <= all; ++j) {
        if (done_[j] != 0) {
            row_price_[row_of_[j]] += step;
            column_price_[j] -= step;
        } else {
            slack_[j] -= step;
        }
    }
    return next;
}

/// Finds a place for one more row by the shortest augmenting path. Rows and columns count from 1; 0 is "none".
void Assignment::augment(std::size_t row) {
    const std::size_t all = columns_ + rows_;
    slack_.assign(all + 1, std::numeric_limits<double>::infinity());
    done_.assign(all + 1, 0);
    row_of_[0] = row;
    std::size_t column = 0;
    do {
        column = nextColumn(column);
    } while (row_of_[column] != 0);
    for (; column != 0; column = from_[column]) row_of_[column] = row_of_[from_[column]];
}

}  // namespace lidar_obstacles
