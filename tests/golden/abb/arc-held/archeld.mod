MODULE archeld
  ! Robotic AM
  ! t_am is the nozzle, which stands; w_am is what the robot holds
  ! set the load of t_am: mass and centre of gravity of what the robot carries
  ! declare on the controller seam5 weld5
  LOCAL PERS tooldata t_am:=[FALSE,[[300.000,0.000,310.500],[0.7071068,0.0000000,0.0000000,0.7071068]],[0.001,[0,0,0.001],[1,0,0,0],0,0,0]];
  LOCAL PERS wobjdata w_am:=[TRUE,TRUE,"",[[0.000,0.000,5.000],[1.0000000,0.0000000,0.0000000,0.0000000]],[[0,0,0],[1,0,0,0]]];
  LOCAL CONST speeddata v_am:=[1000,500,5000,1000];
  LOCAL CONST zonedata z_am1:=[FALSE,0.375,0.375,0.375,0.0375,0.375,0.0375];
  LOCAL CONST speeddata v_am1:=[5.000,500,5000,1000];
  LOCAL PERS welddata d_am1:=[5.000,5.000,[0,0,0,0,0,0,0,0,0],[0,0,0,0,0,0,0,0,0]];
  PROC main()
    ConfL\Off;
    SingArea\Off;
    d_am1:=weld5;
    d_am1.weld_speed:=5.000;
    d_am1.org_weld_speed:=5.000;
    ! layer 0
    MoveAbsJ [[0.0000,-30.0000,120.0000,0.0000,60.0000,0.0000],[9E9,9E9,9E9,9E9,9E9,9E9]]\NoEOffs,v_am\T:=0.50000,fine,t_am\WObj:=w_am;
    MoveAbsJ [[0.0000,-30.0000,120.0000,0.0000,60.0000,0.0000],[9E9,9E9,9E9,9E9,9E9,9E9]]\NoEOffs,v_am\T:=0.50000,fine,t_am\WObj:=w_am;
    ArcLStart [[12.000,0.250,105.000],[0.7071068,0.0000000,0.0000000,0.7071068],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v_am,seam5,d_am1,fine,t_am\WObj:=w_am;
    ArcL [[10.000,0.250,105.000],[1.0000000,0.0000000,0.0000000,0.0000000],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v_am1,seam5,d_am1,z_am1,t_am\WObj:=w_am;
    ArcL [[12.000,0.250,105.000],[0.7071068,0.0000000,0.0000000,0.7071068],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v_am1,seam5,d_am1,z_am1,t_am\WObj:=w_am;
    ArcLEnd [[14.000,0.500,105.000],[0.0000000,0.0000000,1.0000000,0.0000000],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v_am1,seam5,d_am1,fine,t_am\WObj:=w_am;
    ! layer 1
    MoveAbsJ [[0.5000,-30.0000,120.0000,0.0000,60.0000,0.0000],[9E9,9E9,9E9,9E9,9E9,9E9]]\NoEOffs,v_am\T:=0.50000,fine,t_am\WObj:=w_am;
    MoveAbsJ [[0.5000,-30.0000,120.0000,0.0000,60.0000,0.0000],[9E9,9E9,9E9,9E9,9E9,9E9]]\NoEOffs,v_am\T:=0.50000,fine,t_am\WObj:=w_am;
    ArcLStart [[12.000,0.250,106.000],[0.7071068,0.0000000,0.0000000,0.7071068],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v_am,seam5,d_am1,fine,t_am\WObj:=w_am;
    ArcL [[10.000,0.250,105.000],[1.0000000,0.0000000,0.0000000,0.0000000],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v_am1,seam5,d_am1,z_am1,t_am\WObj:=w_am;
    ArcL [[12.000,0.250,106.000],[0.7071068,0.0000000,0.0000000,0.7071068],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v_am1,seam5,d_am1,z_am1,t_am\WObj:=w_am;
    ArcLEnd [[14.000,0.500,105.000],[0.0000000,0.0000000,1.0000000,0.0000000],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v_am1,seam5,d_am1,fine,t_am\WObj:=w_am;
  ENDPROC
ENDMODULE
