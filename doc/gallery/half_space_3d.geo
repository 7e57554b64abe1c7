// A quarter of a half space above z = 0, cut off by the spheroid around the circle of foci x^2 + y^2 = 1: there the exact solutions of contact with a radius
// of 1 are short. Units: m.
SetFactory("OpenCASCADE");
DefineConstant[ b = 2, h = 0.5 ];

Sphere(1) = {0, 0, 0, 1, 0, Pi/2, Pi/2}; // x, y, z >= 0
Dilate{{0, 0, 0}, {Sqrt(1 + b^2), Sqrt(1 + b^2), b}} { Volume{1}; }
e = 1e-3;
far() = Surface{:};
Physical Volume("body") = {1};
Physical Surface("symmetry_x") = Surface In BoundingBox{-e, -e, -e, e, b + 1, b + 1};
Physical Surface("symmetry_y") = Surface In BoundingBox{-e, -e, -e, b + 1, e, b + 1};
Physical Surface("surface") = Surface In BoundingBox{-e, -e, -e, b + 1, b + 1, e};
far() -= Surface In BoundingBox{-e, -e, -e, e, b + 1, b + 1};
far() -= Surface In BoundingBox{-e, -e, -e, b + 1, e, b + 1};
far() -= Surface In BoundingBox{-e, -e, -e, b + 1, b + 1, e};
Physical Surface("far") = far();

MeshSize{ : } = h;
