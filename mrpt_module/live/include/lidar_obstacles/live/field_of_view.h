// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Where a sensor looks, and which packets are missing only because it does not look there.
#pragma once

#include <mrpt/obs/CObservationVelodyneScan.h>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace lidar_obstacles::live {

/// A sensor whose field of view is limited sends nothing while its head looks elsewhere. A gap of 15 degrees or more
/// (two packets, where they are wide) that was in each of the last three turns is such a sector, not a loss. In the
/// first turns it is taken to be one until a later turn shows it.
/// An object is for one thread at a time.
class FieldOfView {
  public:
    using Packet = mrpt::obs::CObservationVelodyneScan::TVelodyneRawPacket;

    /// Takes the newest packet. @param missing  packets between the one before and this one that did not come.
    void add(const Packet& packet, std::size_t missing);
    /// Takes a packet that came after a later one.
    void addLate(const Packet& packet) { see(packet); }
    /// Forgets where the sensor looked, not the packets that are excused: what follows is another sensor.
    void restart();

    /// How many of the missing packets were never sent, as far as it is known. Falls when a later turn shows what an
    /// earlier one did not.
    std::size_t excused() const { return excused_; }
    /// True if the sensor never looks to this azimuth [0.01 deg]; false before three turns have passed.
    bool isOutside(int azimuth) const;
    /// Middle of the widest sector that the sensor never looks to [0.01 deg]; none: it looks all around, or fewer than
    /// three turns have passed.
    std::optional<int> middleOfGap() const;

  private:
    static constexpr int kBins = 360;  ///< of a degree

    /// A sector that no packet has shown yet, and the packets that are missing there.
    struct Unseen {
        int from, size;  ///< [deg]
        std::size_t packets;
        long since;  ///< turned_
    };

    void see(const Packet& packet);
    void excuse(int from, int to, std::size_t missing, long before);
    bool isUnseen(int bin) const;
    double shareUnseen() const;
    int narrowest() const;

    std::array<long, kBins> seen_at_{};  ///< turned_ when it was seen last; 0: never
    long turned_ = 1;                    ///< since the first packet [0.01 deg], outages of whole turns left out
    int newest_ = -1;                    ///< azimuth at which the newest packet begins [0.01 deg]; -1: there is none
    int width_ = 0;                      ///< of a packet [0.01 deg]
    std::vector<Unseen> unseen_;         ///< of the first turns
    std::size_t excused_ = 0;
};

}  // namespace lidar_obstacles::live
