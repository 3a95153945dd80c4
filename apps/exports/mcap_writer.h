// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// MCAP files (https://mcap.dev/spec), as Foxglove and its libraries read them.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "common/text_file.h"

namespace lidar_obstacles::apps {

/// What messages of one topic are.
struct McapChannel {
    std::string topic;
    std::string schema_name;  ///< e.g. "foxglove.Grid"
    std::string schema;       ///< JSON schema
};

/// One message of a channel.
struct McapMessage {
    std::uint16_t channel = 0;  ///< place in the list of channels
    std::uint64_t time = 0;     ///< since the epoch [ns]
    std::string data;           ///< JSON
};

/// Writes an MCAP file with JSON messages: chunks without compression, an index of the messages behind each, a summary
/// with schemas, channels, statistics, the indexes of chunks and metadata, and all check sums.
///
/// The file grows chunk by chunk as `<name>.part` and has its name and its summary from close() on. Where the disk runs
/// full the chunks before stay, which readers recover without a summary.
class McapWriter {
  public:
    /// @param channels  of which messages may come.
    /// @param metadata  of the recording: name and value pairs, under the name `lidar_obstacles`.
    /// @throws std::runtime_error naming the file if it cannot be written.
    McapWriter(const std::filesystem::path& file, std::vector<McapChannel> channels,
               const std::map<std::string, std::string>& metadata);
    /// Closes it; errors are lost here.
    ~McapWriter();
    McapWriter(const McapWriter&) = delete;
    McapWriter& operator=(const McapWriter&) = delete;

    /// Writes messages as one chunk, in the order in which they are given; none: nothing.
    /// @throws std::runtime_error naming the file if it cannot be written.
    void addChunk(const std::vector<McapMessage>& messages);
    /// Writes the summary and gives the file its name. @throws std::runtime_error
    void close();
    /// Takes the file away instead.
    void discard();

  private:
    struct ChunkPlace {
        std::uint64_t begin_time = 0, end_time = 0;  ///< of its messages [ns]
        std::uint64_t offset = 0, length = 0;        ///< of its record
        std::map<std::uint16_t, std::uint64_t> indexes;
        std::uint64_t indexes_length = 0;
        std::uint64_t size = 0;  ///< of its messages
    };

    void append(const std::string& bytes);
    std::string channelRecords(bool schemas) const;
    std::string statistics() const;
    std::string chunkIndexes() const;

    TextFile file_;
    std::vector<McapChannel> channels_;
    std::vector<std::uint32_t> counts_;  ///< messages by channel
    std::vector<ChunkPlace> chunks_;
    std::string metadata_index_;
    std::uint64_t size_ = 0;  ///< of the file so far
    std::uint32_t crc_ = 0;   ///< of the file so far
    bool open_ = true;
};

}  // namespace lidar_obstacles::apps
