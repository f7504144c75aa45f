// A brick of 2 x 1 x 1 m in two halves, its bottom face alone (flat), and the edge of that (line):
// one kind of cells for each file.
//
// gmsh brick.geo -setstring cells KIND -

If (!Exists(cells))
  cells = "triangles";
EndIf
line = StrCmp(cells, "line") == 0;
flat = StrFind(cells, "tri") || StrFind(cells, "quad");
boxes = StrFind(cells, "hex");

Point(1) = {0, 0, 0, 0.6};
Point(2) = {1, 0, 0, 0.6};
Point(3) = {2, 0, 0, 0.6};
Line(1) = {1, 2};
Line(2) = {2, 3};
Physical Point("end") = {3};
If (line)
  Physical Curve("first") = {1};
  Physical Curve("second") = {2};
  Mesh 1;
Else
  If (boxes || StrFind(cells, "quad"))
    Extrude {0, 1, 0} { Curve{1, 2}; Layers{2}; Recombine; }
  Else
    Extrude {0, 1, 0} { Curve{1, 2}; }
  EndIf
EndIf
If (flat)
  Physical Surface("first") = {6};
  Physical Surface("second") = {10};
  Physical Curve("bottom") = {1, 2};
  Mesh 2;
EndIf
If (!flat && !line)
  If (boxes)
    Extrude {0, 0, 1} { Surface{6, 10}; Layers{2}; Recombine; }
  Else
    Extrude {0, 0, 1} { Surface{6, 10}; }
  EndIf
  Physical Volume("first") = {1};
  Physical Volume("second") = {2};
  Physical Surface("bottom") = {6, 10};
  Mesh 3;
EndIf
// raised afterwards, as from the menu: nodes are no longer in the order of their tags
If (StrFind(cells, "6") || StrFind(cells, "10"))
  SetOrder 2;
EndIf
Mesh.MshFileVersion = 4.1;
Save StrCat("brick-", cells, ".msh");
