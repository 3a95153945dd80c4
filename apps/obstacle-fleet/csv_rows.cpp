// SPDX-License-Identifier: BSD-3-Clause
#include "csv_rows.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <stdexcept>
#include <unordered_map>
#include <vector>

namespace lidar_obstacles::fleet {
namespace {

std::vector<std::string> wordsOf(const std::string& header) {
    std::vector<std::string> words;
    words.reserve(static_cast<std::size_t>(std::count(header.begin(), header.end(), ',')) + 1);
    for (std::size_t begin = 0; begin <= header.size();) {
        const std::size_t end = std::min(header.find_first_of(",\n", begin), header.size());
        if (end > begin) words.push_back(header.substr(begin, end - begin));
        begin = end + 1;
    }
    return words;
}

enum Kind : char { kText = 't', kInteger = 'i', kReal = 'r' };

/// Numbers are real but for counts, numbers of things, and what is yes or no.
Kind kindOf(const std::string& column) {
    static const std::unordered_map<std::string, Kind> kKinds = {
        {"class", kText},         {"heading_rule", kText},  {"faces", kText},          {"strange_by", kText},
        {"slowest_stage", kText}, {"scan_index", kInteger}, {"id", kInteger},          {"heading_valid", kInteger},
        {"num_points", kInteger}, {"num_rings", kInteger},  {"seen", kInteger},        {"moving", kInteger},
        {"returns", kInteger},    {"vehicles", kInteger},   {"pedestrians", kInteger}, {"cyclists", kInteger},
        {"structure", kInteger},  {"unknown", kInteger},    {"rejected", kInteger},    {"first_scan", kInteger},
        {"last_scan", kInteger},  {"scans", kInteger},      {"scans_seen", kInteger},  {"direction_known", kInteger}};
    const auto kind = kKinds.find(column);
    return kind == kKinds.end() ? kReal : kind->second;
}

template <typename Number>
void bindNumber(Statement& insert, int column, std::string_view cell, const std::string& place) {
    Number number = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), number);
    if (error != std::errc() || end != cell.data() + cell.size())
        throw std::runtime_error(place + ": '" + std::string(cell) + "' in column " + std::to_string(column) +
                                 ": expected a number");
    insert.bind(column, number);
}

}  // namespace

void createTable(Database& database, const std::string& table, const std::string& header) {
    std::string sql = "CREATE TABLE " + table + "(result INTEGER";
    for (const std::string& column : wordsOf(header)) {
        const Kind kind = kindOf(column);
        sql += ", \"" + column + "\" " + (kind == kText ? "TEXT" : kind == kInteger ? "INTEGER" : "REAL");
    }
    database.run(sql + ")");
}

RowInserter::RowInserter(const Database& database, const std::string& table, std::string header)
    : header_(std::move(header)), insert_([&] {
          std::string sql = "INSERT INTO " + table + " VALUES(?";
          for (std::size_t k = 0; k < wordsOf(header_).size(); ++k) sql += ",?";
          return database.prepare(sql + ")");
      }()) {
    for (const std::string& column : wordsOf(header_)) kinds_ += kindOf(column);
}

std::size_t RowInserter::add(const std::filesystem::path& file, std::int64_t result) {
    std::ifstream in(file);
    std::string line;
    if (!std::getline(in, line) || line + "\n" != header_)
        throw std::runtime_error(file.string() + ":1: expected the columns " + header_.substr(0, header_.size() - 1));
    std::size_t rows = 0;
    while (std::getline(in, line)) {
        ++rows;
        insert_.bind(0, result);
        bindRow(line, file.string() + ':' + std::to_string(rows + 1));
        insert_.run();
    }
    return rows;
}

void RowInserter::bindRow(const std::string& line, const std::string& place) {
    std::size_t begin = 0;
    for (std::size_t k = 0; k < kinds_.size(); ++k) {
        if (begin > line.size())
            throw std::runtime_error(place + ": expected " + std::to_string(kinds_.size()) + " cells");
        const std::size_t end = std::min(line.find(',', begin), line.size());
        const std::string_view cell = std::string_view(line).substr(begin, end - begin);
        const int column = static_cast<int>(k) + 1;
        if (cell.empty())
            insert_.bindNull(column);
        else if (kinds_[k] == kText)
            insert_.bind(column, cell);
        else if (kinds_[k] == kInteger)
            bindNumber<std::int64_t>(insert_, column, cell, place);
        else
            bindNumber<double>(insert_, column, cell, place);
        begin = end + 1;
    }
    if (begin <= line.size())
        throw std::runtime_error(place + ": expected " + std::to_string(kinds_.size()) + " cells");
}

}  // namespace lidar_obstacles::fleet
