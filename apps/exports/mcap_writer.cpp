// SPDX-License-Identifier: BSD-3-Clause
#include "exports/mcap_writer.h"

#include <zlib.h>

#include <algorithm>
#include <utility>

#include "exports/bytes.h"

namespace lidar_obstacles::apps {
namespace {

/// Kinds of records, as the specification numbers them.
enum Op : std::uint8_t {
    kHeader = 1,
    kFooter = 2,
    kSchema = 3,
    kChannel = 4,
    kMessage = 5,
    kChunk = 6,
    kMessageIndex = 7,
    kChunkIndex = 8,
    kStatistics = 11,
    kMetadata = 12,
    kMetadataIndex = 13,
    kSummaryOffset = 14,
    kDataEnd = 15
};

const std::string kMagic("\x89MCAP0\r\n", 8);

std::uint32_t crcOf(const std::string& bytes, std::uint32_t before = 0) {
    uLong crc = before;
    // zlib counts in 32 bits
    constexpr std::size_t kStep = std::size_t{1} << 30U;
    for (std::size_t at = 0; at < bytes.size(); at += kStep)
        crc = crc32(crc, reinterpret_cast<const Bytef*>(bytes.data()) + at,
                    static_cast<uInt>(std::min(kStep, bytes.size() - at)));
    return static_cast<std::uint32_t>(crc);
}

std::string record(Op op, const std::string& content) {
    std::string bytes(1, static_cast<char>(op));
    putInteger(bytes, static_cast<std::uint64_t>(content.size()));
    return bytes + content;
}

/// With its length before it.
void putString(std::string& bytes, const std::string& text) {
    putInteger(bytes, static_cast<std::uint32_t>(text.size()));
    bytes += text;
}

std::string messageRecord(const McapMessage& message, std::uint32_t sequence) {
    std::string content;
    content.reserve(message.data.size() + 22);
    putInteger(content, message.channel);
    putInteger(content, sequence);
    putInteger(content, message.time);
    putInteger(content, message.time);
    content += message.data;
    return record(kMessage, content);
}

std::string metadataRecord(const std::map<std::string, std::string>& metadata) {
    std::string pairs, content;
    for (const auto& [name, value] : metadata) {
        putString(pairs, name);
        putString(pairs, value);
    }
    putString(content, "lidar_obstacles");
    putString(content, pairs);
    return record(kMetadata, content);
}

/// The messages of one channel in a chunk, as (time, offset in the chunk).
using MessagePlaces = std::vector<std::pair<std::uint64_t, std::uint64_t>>;

std::string indexRecord(std::uint16_t channel, MessagePlaces places) {
    std::stable_sort(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::string content, pairs;
    for (const auto& [time, offset] : places) {
        putInteger(pairs, time);
        putInteger(pairs, offset);
    }
    putInteger(content, channel);
    putString(content, pairs);
    return record(kMessageIndex, content);
}

}  // namespace

McapWriter::McapWriter(const std::filesystem::path& file, std::vector<McapChannel> channels,
                       const std::map<std::string, std::string>& metadata)
    : file_(file), channels_(std::move(channels)), counts_(channels_.size(), 0) {
    std::string header;
    putString(header, "");  // no profile
    putString(header, "lidar_obstacles");
    const std::string pairs = metadataRecord(metadata);
    std::string begin = kMagic + record(kHeader, header);
    putInteger(metadata_index_, static_cast<std::uint64_t>(begin.size()));
    putInteger(metadata_index_, static_cast<std::uint64_t>(pairs.size()));
    putString(metadata_index_, "lidar_obstacles");
    append(begin + pairs + channelRecords(true) + channelRecords(false));
}

McapWriter::~McapWriter() {
    try {
        close();
    } catch (const std::exception&) {  // close() before if it matters
    }
}

void McapWriter::append(const std::string& bytes) {
    try {
        file_.append(bytes);
    } catch (const std::exception&) {
        open_ = false;
        throw;
    }
    size_ += bytes.size();
    crc_ = crcOf(bytes, crc_);
}

std::string McapWriter::channelRecords(bool schemas) const {
    std::string records;
    for (std::size_t k = 0; k < channels_.size(); ++k) {
        const auto schema_id = static_cast<std::uint16_t>(k + 1);  // 0 means "no schema"
        std::string content;
        if (schemas) {
            putInteger(content, schema_id);
            for (const std::string& text : {channels_[k].schema_name, std::string("jsonschema"), channels_[k].schema})
                putString(content, text);
        } else {
            putInteger(content, static_cast<std::uint16_t>(k));
            putInteger(content, schema_id);
            for (const std::string& text : {channels_[k].topic, std::string("json"), std::string()})
                putString(content, text);
        }
        records += record(schemas ? kSchema : kChannel, content);
    }
    return records;
}

void McapWriter::addChunk(const std::vector<McapMessage>& messages) {
    if (messages.empty()) return;
    ChunkPlace place;
    place.begin_time = messages.front().time;
    std::map<std::uint16_t, MessagePlaces> places;
    std::string records;
    for (const McapMessage& m : messages) {
        place.begin_time = std::min(place.begin_time, m.time);
        place.end_time = std::max(place.end_time, m.time);
        places[m.channel].emplace_back(m.time, records.size());
        records += messageRecord(m, counts_[m.channel]++);
    }
    std::string content;
    content.reserve(records.size() + 40);
    for (const std::uint64_t number : {place.begin_time, place.end_time, static_cast<std::uint64_t>(records.size())})
        putInteger(content, number);
    putInteger(content, crcOf(records));
    putString(content, "");  // no compression
    putInteger(content, static_cast<std::uint64_t>(records.size()));
    content += records;
    std::string bytes = record(kChunk, content);
    place.offset = size_;
    place.length = bytes.size();
    place.size = records.size();
    for (const auto& [channel, of_channel] : places) {
        place.indexes[channel] = size_ + bytes.size();
        bytes += indexRecord(channel, of_channel);
    }
    place.indexes_length = bytes.size() - place.length;
    append(bytes);
    chunks_.push_back(std::move(place));
}

std::string McapWriter::statistics() const {
    std::string content, counts;
    std::uint64_t messages = 0, begin = chunks_.empty() ? 0 : chunks_.front().begin_time, end = 0;
    for (std::size_t k = 0; k < counts_.size(); ++k) {
        messages += counts_[k];
        putInteger(counts, static_cast<std::uint16_t>(k));
        putInteger(counts, static_cast<std::uint64_t>(counts_[k]));
    }
    for (const ChunkPlace& c : chunks_) {
        begin = std::min(begin, c.begin_time);
        end = std::max(end, c.end_time);
    }
    putInteger(content, messages);
    putInteger(content, static_cast<std::uint16_t>(channels_.size()));  // schemas
    putInteger(content, static_cast<std::uint32_t>(channels_.size()));
    for (const std::uint32_t attachments_metadata_chunks : {0U, 1U, static_cast<std::uint32_t>(chunks_.size())})
        putInteger(content, attachments_metadata_chunks);
    putInteger(content, begin);
    putInteger(content, end);
    putString(content, counts);
    return record(kStatistics, content);
}

std::string McapWriter::chunkIndexes() const {
    std::string records;
    for (const ChunkPlace& c : chunks_) {
        std::string content, indexes;
        for (const std::uint64_t number : {c.begin_time, c.end_time, c.offset, c.length}) putInteger(content, number);
        for (const auto& [channel, offset] : c.indexes) {
            putInteger(indexes, channel);
            putInteger(indexes, offset);
        }
        putString(content, indexes);
        putInteger(content, c.indexes_length);
        putString(content, "");
        putInteger(content, c.size);
        putInteger(content, c.size);
        records += record(kChunkIndex, content);
    }
    return records;
}

void McapWriter::close() {
    if (!open_) return;
    open_ = false;
    std::string data_crc;
    putInteger(data_crc, crc_);
    append(record(kDataEnd, data_crc));
    const std::uint64_t summary_start = size_;
    std::string summary, offsets;
    for (const auto& [op, group] : {std::pair(kSchema, channelRecords(true)),
                                    {kChannel, channelRecords(false)},
                                    {kStatistics, statistics()},
                                    {kMetadataIndex, record(kMetadataIndex, metadata_index_)},
                                    {kChunkIndex, chunkIndexes()}}) {
        if (group.empty()) continue;
        std::string place(1, static_cast<char>(op));
        putInteger(place, summary_start + summary.size());
        putInteger(place, static_cast<std::uint64_t>(group.size()));
        offsets += record(kSummaryOffset, place);
        summary += group;
    }
    std::string places;
    putInteger(places, summary_start);
    putInteger(places, summary_start + summary.size());
    // The check sum covers the summary and the footer up to itself.
    std::string crc(4, '\0');
    std::string footer = record(kFooter, places + crc);
    footer.resize(footer.size() - crc.size());
    crc.clear();
    putInteger(crc, crcOf(summary + offsets + footer));
    append(summary + offsets + footer + crc + kMagic);
    file_.close();
}

void McapWriter::discard() {
    open_ = false;
    file_.discard();
}

}  // namespace lidar_obstacles::apps
