// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// SQLite, with errors as exceptions that name the file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace lidar_obstacles::fleet {

class Database;

/// A statement of SQL. Parameters and columns are counted from 0.
class Statement {
  public:
    void bind(int parameter, std::int64_t value);
    void bind(int parameter, double value);
    /// The text has to outlive step().
    void bind(int parameter, std::string_view text);
    void bindNull(int parameter);
    /// The next row; false at the end, after which parameters can be bound anew.
    bool step();
    /// Runs a statement that gives no rows.
    void run() {
        while (step()) {
        }
    }

    std::int64_t integer(int column) const;
    double real(int column) const;
    std::string text(int column) const;
    bool isNull(int column) const;

  private:
    friend class Database;
    struct Finalize {
        void operator()(sqlite3_stmt* s) const;
    };
    Statement(sqlite3_stmt* statement, const Database& database) : statement_(statement), database_(&database) {}
    void check(int code) const;

    std::unique_ptr<sqlite3_stmt, Finalize> statement_;
    const Database* database_;
};

/// A database file. All functions throw std::runtime_error with its name and what SQLite says.
class Database {
  public:
    enum class Mode : std::uint8_t {
        New,   ///< in the place of what is there; not safe against a power cut until it is closed
        Read,  ///< has to be there
    };
    Database(std::filesystem::path file, Mode mode);

    void run(const std::string& sql);
    Statement prepare(const std::string& sql) const;
    const std::filesystem::path& file() const { return file_; }

  private:
    friend class Statement;
    struct Close {
        void operator()(sqlite3* d) const;
    };
    [[noreturn]] void fail() const;

    std::filesystem::path file_;
    std::unique_ptr<sqlite3, Close> database_;
};

}  // namespace lidar_obstacles::fleet
