// Reads triangle meshes and point clouds from the mesh files of robot descriptions; writes meshes for
// viewing.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "fcl_stpbv/volume/tessellate.h"

namespace fcl_stpbv {

/// Reads all meshes of a file as one mesh (m). The formats are STL, OBJ, COLLADA, PLY, glTF, OFF and most
/// others of assimp. The transforms of the file's nodes are applied, then `scale` along each axis. Vertices
/// with equal coordinates are merged.
///
/// COLLADA's `unit` is applied, so lengths are in metres. Its `up_axis` is ignored, as in rviz and MoveIt,
/// for which robot descriptions are made: a point's x stays x. In other formats coordinates are taken as
/// metres. 3MF, AMF, DXF, FBX and OpenGEX state a unit that cannot be read, so they are an error; so is X3D
/// if it states a unit. assimp stores single precision: a coordinate of 1 m is accurate to 0.06 um.
///
/// A cloud gives its points without triangles, in double precision and without merging. It is a polyhedron or
/// point file of qhull (`*-ch.txt`, `.otp`, `.qc`, `.cloud`), or a text with three coordinates a line as in
/// `.xyz` and `.pts`. If the name has no ending, a cloud is recognised by its content.
/// @throws Error naming the file and what would work.
TriangleMesh loadMesh(const std::string& path, const Eigen::Vector3d& scale = {1, 1, 1});

/// loadMesh() of a file's content; `name` stands for it in messages. The format is recognised by the content
/// alone. Other files that the content refers to, such as the buffers of a glTF, are not read.
/// @throws Error as loadMesh().
TriangleMesh parseMesh(const std::string& content, const std::string& name,
                       const Eigen::Vector3d& scale = {1, 1, 1});

/// Reads only the points of such a file (m).
/// @throws Error naming the file and what would work.
std::vector<Eigen::Vector3d> loadPoints(const std::string& path, const Eigen::Vector3d& scale = {1, 1, 1});

/// Whether saveMesh() knows a format for this name, that is, the name ends in .obj, .stl, .ply or .glb.
bool canSaveMesh(const std::string& path);

/// Writes a mesh in the format of the name's ending. Coordinates are written unchanged, in single precision.
/// If the write fails or is interrupted, an existing file stays unchanged.
/// @throws Error naming the file and what would work.
void saveMesh(const std::string& path, const TriangleMesh& mesh);

/// Writes several meshes into one file. Each has its own colour if the format has colours (.ply and .glb).
/// @throws Error as saveMesh().
void saveColoured(const std::string& path, const std::vector<TriangleMesh>& meshes);

}  // namespace fcl_stpbv
