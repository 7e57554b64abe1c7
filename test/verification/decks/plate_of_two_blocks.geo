// A thin plate of two blocks, 38 x 3 cells.
Point(1) = {0, 0, 0}; Point(2) = {0.87, 0, 0}; Point(3) = {1, 0, 0};
Point(4) = {1, 0.056, 0}; Point(5) = {0.87, 0.056, 0}; Point(6) = {0, 0.056, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 1}; Line(7) = {2, 5};
Curve Loop(1) = {1, 7, 5, 6}; Plane Surface(1) = {1};
Curve Loop(2) = {2, 3, 4, -7}; Plane Surface(2) = {2};
Transfinite Curve {1, 5} = 34; Transfinite Curve {2, 4} = 6; Transfinite Curve {3, 6, 7} = 4;
Transfinite Surface {1, 2};
Recombine Surface {1, 2};
Physical Curve("bottom") = {1, 2}; Physical Curve("right") = {3}; Physical Curve("top") = {4, 5}; Physical Curve("left") = {6};
Physical Surface("soft") = {1}; Physical Surface("stiff") = {2};
