// Reads triangle meshes and point clouds from the files that robots ship; writes meshes for viewing.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "fcl_stpbv/volume/tessellate.h"

namespace fcl_stpbv {

/// Reads all meshes of a file (STL, OBJ, COLLADA, PLY, glTF, OFF and what else assimp knows) as one, with the
/// transforms of its nodes applied, then `scale` along each axis. Vertices with equal coordinates become one.
///
/// COLLADA's `unit` is applied, so lengths are in metres. Its `up_axis` is not, as in rviz and MoveIt, for
/// which robot descriptions are made: a point's x stays x. Coordinates in other formats are taken as metres;
/// 3MF, AMF, DXF, FBX and OpenGEX, which state a unit that is not read, are refused, and X3D where it states
/// one. assimp stores single precision: a
/// coordinate of 1 m is good to 0.06 um.
///
/// Of a qhull polyhedron or point file (`*-ch.txt`, `*.otp`, told by their content; double precision and as
/// many points as the file holds) the points alone, without triangles.
/// @throws Error naming the file and what would work.
TriangleMesh loadMesh(const std::string& path, const Eigen::Vector3d& scale = {1, 1, 1});

/// The points of such a file.
/// @throws Error naming the file and what would work.
std::vector<Eigen::Vector3d> loadPoints(const std::string& path, const Eigen::Vector3d& scale = {1, 1, 1});

/// Whether saveMesh() knows a format for this name: it ends in .obj, .stl, .ply or .glb.
bool canSaveMesh(const std::string& path);

/// Writes a mesh in the format its name ends in, coordinates as they are, in single precision. A failed or
/// interrupted write leaves an old file as it was.
/// @throws Error naming the file and what would work.
void saveMesh(const std::string& path, const TriangleMesh& mesh);

/// Writes several meshes as one, each in a colour of its own where the format has colours: .ply and .glb.
/// @throws Error as saveMesh().
void saveColoured(const std::string& path, const std::vector<TriangleMesh>& meshes);

}  // namespace fcl_stpbv
