// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Where scans come from: one way to read rawlogs and Velodyne captures, object by object, in constant memory.
#pragma once

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lidar_obstacles {

/// One thing read from a source: an observation or, from rawlogs in action/sensory-frame format, the robot's action
/// between two frames (odometry). Exactly one of the two pointers is set.
struct SourceItem {
    mrpt::obs::CObservation::Ptr observation;
    mrpt::obs::CActionCollection::Ptr action;
    std::size_t object = 0;  ///< number of the object in the file, from 0; the observations of a frame share theirs
    /// The observation's points are stored in a file of their own that is missing or cannot be read: it is a scan, of
    /// which there is nothing.
    bool is_gap = false;
    /// Name of the lidar whose scan the observation is: its sensorLabel, or, of further lidars that were recorded under
    /// the same label with another class or another place on the vehicle, "LABEL#2" and so on.
    std::string lidar = {};
    /// Scans of further lidars that belong to the same time (JoinedLidars), each with its own sensorPose.
    std::vector<mrpt::obs::CObservation::Ptr> beside = {};
};

/// What is known of an input besides its name.
struct InputOptions {
    std::optional<std::uint16_t> port;    ///< of captures: only data packets to this UDP port; none: to any
    std::optional<std::uint32_t> sender;  ///< of captures: only packets of this IPv4 address, first byte highest
    std::string sensor_model;             ///< of captures: "vlp-16", "puck-hi-res" ...; empty: what the packets name
    bool with_clouds = true;              ///< of rawlogs: also read the clouds that are stored in files of their own

    bool areForCaptures() const { return port || sender || !sensor_model.empty(); }
};

/// The words that InputOptions::sensor_model may be.
std::vector<std::string> sensorModels();

enum class SourceStatus : std::uint8_t {
    Open,     ///< there may be more
    End,      ///< read to a clean end; an empty file ends at object 0
    Damaged,  ///< what followed could not be read: see ScanSource::message()
};

/// A file of observations, read from front to end. Everything before a damage is delivered.
/// An object is for one thread at a time.
class ScanSource {
  public:
    virtual ~ScanSource() = default;

    /// The next item; nullopt at the end and at damage, told apart by status(). Never throws for what the file
    /// holds.
    virtual std::optional<SourceItem> next() = 0;
    virtual SourceStatus status() const = 0;
    /// Objects read without error so far (rawlog: MRPT objects; capture: scans).
    virtual std::size_t objects() const = 0;
    /// Why the source is Damaged: file, object number and reason in one line; empty otherwise.
    virtual const std::string& message() const = 0;
    /// What was left out without ending the source, e.g. truncated packets, in one line; empty if nothing.
    virtual std::string remarks() const = 0;
    /// Share of the file that has been read, 0 .. 1.
    virtual double progress() const = 0;
};

/// A source that does something to the items of another; all else is what the other says.
/// An object is for one thread at a time.
class ScanSourceFilter : public ScanSource {
  public:
    /// @param source  must outlive this.
    explicit ScanSourceFilter(ScanSource& source) : source_(source) {}

    SourceStatus status() const override { return source_.status(); }
    std::size_t objects() const override { return source_.objects(); }
    const std::string& message() const override { return source_.message(); }
    std::string remarks() const override { return source_.remarks(); }
    double progress() const override { return source_.progress(); }

  protected:
    ScanSource& source_;
};

/// Opens a rawlog or a capture (pcap, pcapng), each plain or gzip, by what the file begins with, whatever its name.
/// @throws std::runtime_error naming the file if it cannot be opened, is neither, e.g. a picture, or can be read once
///         only (a pipe); std::invalid_argument if the options are for captures and it is none.
std::unique_ptr<ScanSource> openScanSource(const std::string& path, const InputOptions& options = {});

/// Name (SourceItem::lidar) and number of scans of each lidar among the first `max_objects` objects of a file; what
/// stands before a damage counts.
/// @throws as openScanSource.
std::map<std::string, std::size_t> lidarLabels(const std::string& path,
                                               std::size_t max_objects = std::numeric_limits<std::size_t>::max(),
                                               const InputOptions& options = {});

}  // namespace lidar_obstacles
