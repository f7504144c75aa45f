// A hollow block on a stiff plate: 30 x 10 x 8 mm, the plate 2 mm of that, with an air chamber of
// 22 x 4 x 3 mm inside. Drawn in millimetres, saved in metres.
//
// gmsh -3 finger.geo

SetFactory("OpenCASCADE");
Mesh.ElementOrder = 2;
Mesh.ScalingFactor = 0.001;
Mesh.MshFileVersion = 4.1;
Mesh.CharacteristicLengthMin = 4;
Mesh.CharacteristicLengthMax = 4;

Box(1) = {0, 0, 2, 30, 10, 6};
Box(2) = {4, 3, 3.5, 22, 4, 3};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Box(4) = {0, 0, 0, 30, 10, 2};
BooleanFragments{ Volume{3, 4}; Delete; }{ }

eps = 1e-3;
Physical Volume("rubber") = Volume In BoundingBox {-eps, -eps, 2 - eps, 30 + eps, 10 + eps, 8 + eps};
Physical Volume("plate") = Volume In BoundingBox {-eps, -eps, -eps, 30 + eps, 10 + eps, 2 + eps};
Physical Surface("chamber") = Surface In BoundingBox {4 - eps, 3 - eps, 3.5 - eps, 26 + eps, 7 + eps, 6.5 + eps};
Physical Surface("clamp") = Surface In BoundingBox {-eps, -eps, -eps, eps, 10 + eps, 8 + eps};
