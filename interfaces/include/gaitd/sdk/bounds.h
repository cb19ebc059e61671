// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

/// What gaitd and its programs read at most of anything that comes from outside: a file, a socket,
/// a plugin. Each is far above what is sensible and far below what makes a reader slow or large.
namespace gaitd::bounds {

// ---- YAML: gaitd.yaml, robot.yaml, scenarios, campaigns, footsteps.

/// Bytes of a file or of standard input. The largest of ours has 10 kB; 10,000 commands in one
/// scenario have 0.6 MB.
inline constexpr std::size_t kYamlBytes = 1u << 20;
inline constexpr int kYamlDepth = 32;  ///< ours have 6
/// Keys and values, with every alias expanded. Those 10,000 commands have 150,000.
inline constexpr std::size_t kYamlValues = 200'000;
/// Characters of a key, dotted paths among them; the longest of ours has 60.
inline constexpr std::size_t kYamlKey = 256;
/// Keys of all sources together; there are 400 parameters.
inline constexpr std::size_t kSettings = 2000;
/// Characters of a glob that names parameters.
inline constexpr std::size_t kParameterGlob = 256;

// ---- URDF.

/// Bytes of a file. Robots with all their visuals and sensors have 1 MB.
inline constexpr std::size_t kUrdfBytes = 4u << 20;
inline constexpr int kUrdfDepth = 100;       ///< a URDF has 6; TinyXML calls itself for each
inline constexpr int kUrdfAttributes = 100;  ///< of one element, which TinyXML compares pairwise

/// Bytes of a mesh of a foot, which `gaitctl robot init` reads; those published have 10 MB at most.
inline constexpr std::size_t kMeshBytes = 32u << 20;
inline constexpr std::size_t kMeshPoints = 2'000'000;  ///< corners of it that are looked at

// ---- The socket of commands.

/// Of one line, and of those of a client that wait; 64 footsteps with all they can have, the most
/// in one command, have 0.1 MB.
inline constexpr std::size_t kRequestBytes = 256u << 10;
/// JSON values in one line, each of which takes up to 60 bytes when it is read; those 64 footsteps
/// have 4500.
inline constexpr std::size_t kRequestValues = 16384;
/// An e-stop in a line of at most so many bytes is acted on before everything else.
inline constexpr std::size_t kEstopBytes = 4096;
inline constexpr std::size_t kLinesWaiting = 16;     ///< of one client, then it is not read
inline constexpr std::size_t kCommandsWaiting = 64;  ///< of one client for the control thread
inline constexpr std::size_t kCommandsPerTick = 16;  ///< of all clients
inline constexpr int kFootstepsPerTick = 64;  ///< in commands of clients, then no further one
/// Of a variant or the path of a library: PATH_MAX of Linux.
inline constexpr std::size_t kPathBytes = 4096;
inline constexpr int kClients = 64;        ///< of each socket, that stay connected
inline constexpr int kGuests = 128;        ///< beyond them, for one request each
inline constexpr int kRequestDepth = 32;   ///< of nested arrays and objects
inline constexpr int kRequestBatch = 256;  ///< requests in one line
/// Bytes of answers that a client has not read; the longest answer, plugin.list, has 0.2 MB.
inline constexpr std::size_t kUnreadBytes = 1u << 20;

// ---- Plugins.

/// Bytes of a library; a debug build with everything linked statically has 60 MB. All of it is
/// locked in memory while it is loaded.
inline constexpr std::size_t kLibraryBytes = 256u << 20;
/// Bytes of what a child that tries a library reports; a sound one needs 200.
inline constexpr std::size_t kChildReportBytes = 64u << 10;
/// Libraries that cannot be unloaded and that nobody uses any more.
inline constexpr std::size_t kIdleLibraries = 16;
/// Swaps and rollbacks of clients that are not over yet; there are five layers.
inline constexpr int kOpenSwaps = 8;

}  // namespace gaitd::bounds
