// The beam with cells of size h r^grading at the distance r from the nearest corner, where
// the displacement is singular. accuracy.py puts h and grading before this text.
Point(1) = {0, 0, 0};
Point(2) = {5, 0, 0};
Point(3) = {5, 1, 0};
Point(4) = {0, 1, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Physical Surface("body") = {1};
Physical Curve("bottom") = {1};
Physical Curve("right") = {2};
Physical Curve("top") = {3};
Physical Curve("left") = {4};

Field[1] = Distance;
Field[1].PointsList = {1, 2, 3, 4};
Field[2] = MathEval;
Field[2].F = Sprintf("%g*(F1+%g)^%g", h, h^4, grading);
Background Field = 2;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.Algorithm = 6; // Frontal-Delaunay
