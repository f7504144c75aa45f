// A fish seen from above, 0.2 m long: a head, muscles on both sides of the middle line, and a tail. Lengths here are in millimetres, in
// the mesh in metres.
//
// gmsh -2 fish.geo

Mesh.ScalingFactor = 0.001;
Mesh.MshFileVersion = 4.1;

Point(1) = {0, 0, 0, 8};
Point(2) = {4, 7, 0, 8};
Point(3) = {20, 14, 0, 8};
Point(4) = {60, 15, 0, 8};
Point(5) = {95, 11, 0, 6};
Point(6) = {130, 6, 0, 5};
Point(7) = {165, 3, 0, 4};
Point(8) = {200, 1.5, 0, 4};
Point(9) = {60, 0, 0, 8};
Point(10) = {130, 0, 0, 5};
Point(12) = {4, -7, 0, 8};
Point(13) = {20, -14, 0, 8};
Point(14) = {60, -15, 0, 8};
Point(15) = {95, -11, 0, 6};
Point(16) = {130, -6, 0, 5};
Point(17) = {165, -3, 0, 4};
Point(18) = {200, -1.5, 0, 4};

Spline(1) = {14, 13, 12, 1, 2, 3, 4}; // the head, from right to left
Line(2) = {4, 9};
Line(3) = {9, 14};
Spline(4) = {4, 5, 6};
Line(5) = {6, 10};
Line(6) = {10, 9};
Spline(7) = {14, 15, 16};
Line(8) = {16, 10};
Spline(9) = {6, 7, 8};
Line(10) = {8, 18};
Spline(11) = {16, 17, 18};

Curve Loop(1) = {1, 2, 3};
Plane Surface(1) = {1};
Curve Loop(2) = {4, 5, 6, -2};
Plane Surface(2) = {2};
Curve Loop(3) = {7, 8, 6, 3};
Plane Surface(3) = {3};
Curve Loop(4) = {9, 10, -11, 8, -5};
Plane Surface(4) = {4};

Physical Surface("head") = {1};
Physical Surface("left") = {2};
Physical Surface("right") = {3};
Physical Surface("tail") = {4};
Physical Curve("end") = {10};
