// SPDX-License-Identifier: BSD-3-Clause
#include "sequence/track_assignment.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace lidar_obstacles {

/// Columns beyond the real ones stand for "none": each row has one of its own choice at the limit.
double Assignment::cost(std::size_t row, std::size_t column) const {
    const std::size_t columns = own_columns_.size();
    return column < columns ? std::min(limit_, own_costs_[row * columns + column]) : limit_;
}

const std::vector<int>& Assignment::solve(const std::vector<double>& costs, std::size_t rows, std::size_t columns,
                                          double limit) {
    limit_ = limit;
    column_of_.assign(rows, -1);
    findGroups(costs, rows, columns);
    for (std::size_t row = 0; row < rows; ++row)
        if (group_of_[row] == row) solveGroup(costs, columns, row);
    return column_of_;
}

std::size_t Assignment::rootOf(std::size_t row) const {
    while (group_of_[row] != row) row = group_of_[row];
    return row;
}

/// Rows that may want the same column are of one group, named by its first row.
void Assignment::findGroups(const std::vector<double>& costs, std::size_t rows, std::size_t columns) {
    group_of_.resize(rows);
    std::iota(group_of_.begin(), group_of_.end(), std::size_t{0});
    first_row_.assign(columns, rows);
    for (std::size_t row = 0; row < rows; ++row) {
        for (std::size_t column = 0; column < columns; ++column) {
            if (!(costs[row * columns + column] < limit_)) continue;
            if (first_row_[column] == rows) first_row_[column] = row;
            const std::size_t one = rootOf(row), other = rootOf(first_row_[column]);
            group_of_[std::max(one, other)] = std::min(one, other);
        }
    }
    for (std::size_t row = 0; row < rows; ++row) group_of_[row] = rootOf(row);
}

void Assignment::solveGroup(const std::vector<double>& costs, std::size_t columns, std::size_t group) {
    own_rows_.clear();
    own_columns_.clear();
    for (std::size_t row = group; row < group_of_.size(); ++row)
        if (group_of_[row] == group) own_rows_.push_back(row);
    for (std::size_t column = 0; column < columns; ++column)
        if (first_row_[column] < group_of_.size() && group_of_[first_row_[column]] == group)
            own_columns_.push_back(column);
    own_costs_.clear();
    for (const std::size_t row : own_rows_)
        for (const std::size_t column : own_columns_) own_costs_.push_back(costs[row * columns + column]);
    const std::size_t all = own_columns_.size() + own_rows_.size();
    row_price_.assign(own_rows_.size() + 1, 0.0);
    column_price_.assign(all + 1, 0.0);
    row_of_.assign(all + 1, 0);
    from_.assign(all + 1, 0);
    for (std::size_t row = 1; row <= own_rows_.size(); ++row) augment(row);
    for (std::size_t column = 1; column <= own_columns_.size(); ++column) {
        if (row_of_[column] == 0 || !(cost(row_of_[column] - 1, column - 1) < limit_)) continue;
        column_of_[own_rows_[row_of_[column] - 1]] = static_cast<int>(own_columns_[column - 1]);
    }
}

/// One step of the path: from a column that is done to the nearest one that is not; the prices follow.
std::size_t Assignment::nextColumn(std::size_t column) {
    const std::size_t all = own_columns_.size() + own_rows_.size();
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
    const std::size_t all = own_columns_.size() + own_rows_.size();
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
