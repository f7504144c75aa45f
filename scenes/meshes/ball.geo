// A ball of 14 mm. Lengths here are in millimetres, in the mesh in metres.
//
// gmsh -3 ball.geo

SetFactory("OpenCASCADE");
Mesh.ScalingFactor = 0.001;
Mesh.MshFileVersion = 4.1;
Mesh.MeshSizeMin = 10;
Mesh.ElementOrder = 2;

Sphere(1) = {0, 0, 0, 14};
