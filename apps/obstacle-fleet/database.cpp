// SPDX-License-Identifier: BSD-3-Clause
#include "database.h"

#include <sqlite3.h>

#include <stdexcept>
#include <utility>

namespace lidar_obstacles::fleet {

void Statement::Finalize::operator()(sqlite3_stmt* s) const { sqlite3_finalize(s); }
void Database::Close::operator()(sqlite3* d) const { sqlite3_close(d); }

void Statement::check(int code) const {
    if (code != SQLITE_OK) database_->fail();
}

void Statement::bind(int parameter, std::int64_t value) {
    check(sqlite3_bind_int64(statement_.get(), parameter + 1, value));
}

void Statement::bind(int parameter, double value) {
    check(sqlite3_bind_double(statement_.get(), parameter + 1, value));
}

void Statement::bind(int parameter, std::string_view text) {
    check(
        sqlite3_bind_text(statement_.get(), parameter + 1, text.data(), static_cast<int>(text.size()), SQLITE_STATIC));
}

void Statement::bindNull(int parameter) { check(sqlite3_bind_null(statement_.get(), parameter + 1)); }

bool Statement::step() {
    const int code = sqlite3_step(statement_.get());
    if (code == SQLITE_ROW) return true;
    if (code != SQLITE_DONE) database_->fail();
    check(sqlite3_reset(statement_.get()));
    return false;
}

std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }

double Statement::real(int column) const { return sqlite3_column_double(statement_.get(), column); }

std::string Statement::text(int column) const {
    const unsigned char* text = sqlite3_column_text(statement_.get(), column);
    return text == nullptr ? "" : reinterpret_cast<const char*>(text);
}

bool Statement::isNull(int column) const { return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL; }

Database::Database(std::filesystem::path file, Mode mode) : file_(std::move(file)) {
    std::error_code ignored;
    if (mode == Mode::New) std::filesystem::remove(file_, ignored);
    const int flags = mode == Mode::New ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE : SQLITE_OPEN_READONLY;
    sqlite3* opened = nullptr;
    const int code = sqlite3_open_v2(file_.c_str(), &opened, flags, nullptr);
    database_.reset(opened);
    if (code != SQLITE_OK) fail();
    if (mode == Mode::New) run("PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF");
}

void Database::run(const std::string& sql) {
    if (sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) fail();
}

Statement Database::prepare(const std::string& sql) const {
    sqlite3_stmt* statement = nullptr;
    if (sqlite3_prepare_v2(database_.get(), sql.c_str(), -1, &statement, nullptr) != SQLITE_OK) fail();
    return {statement, *this};
}

void Database::fail() const {
    throw std::runtime_error(file_.string() + ": " +
                             (database_ ? sqlite3_errmsg(database_.get()) : "SQLite has no memory"));
}

}  // namespace lidar_obstacles::fleet
