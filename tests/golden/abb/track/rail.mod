MODULE rail
  ! Robotic AM
  ! eax_c is the track in mm, which moves the base frame of the robot
  ! set the load of t_am: mass and centre of gravity of what the robot carries
  LOCAL PERS tooldata t_am:=[TRUE,[[0.000,0.000,5.000],[1.0000000,0.0000000,0.0000000,0.0000000]],[0.001,[0,0,0.001],[1,0,0,0],0,0,0]];
  LOCAL PERS wobjdata w_am:=[FALSE,TRUE,"",[[1200.000,0.000,20.000],[1.0000000,0.0000000,0.0000000,0.0000000]],[[0,0,0],[1,0,0,0]]];
  LOCAL CONST speeddata v_am:=[1000,500,5000,1000];
  LOCAL CONST zonedata z_am1:=[FALSE,0.375,0.375,0.375,0.0375,0.375,0.0375];
  PROC main()
    ConfL\Off;
    SingArea\Off;
    ! layer 0
    MoveAbsJ [[0.0000,-30.0000,120.0000,0.0000,60.0000,0.0000],[9E9,9E9,-900.1250,9E9,9E9,9E9]]\NoEOffs,v_am\T:=0.50000,fine,t_am\WObj:=w_am;
    MoveAbsJ [[0.0000,-30.0000,120.0000,0.0000,60.0000,0.0000],[9E9,9E9,-887.6250,9E9,9E9,9E9]]\NoEOffs,v_am\T:=0.50000,fine,t_am\WObj:=w_am;
    SetDO do1,1;
    MoveL [[10.000,0.250,105.000],[1.0000000,0.0000000,0.0000000,0.0000000],[0,0,0,0],[9E9,9E9,-875.1250,9E9,9E9,9E9]],v_am\V:=5.000,z_am1,t_am\WObj:=w_am;
    MoveL [[12.000,0.250,105.000],[0.7071068,0.0000000,0.0000000,0.7071068],[0,0,0,0],[9E9,9E9,-862.6250,9E9,9E9,9E9]],v_am\V:=5.000,z_am1,t_am\WObj:=w_am;
    MoveL [[14.000,0.500,105.000],[0.0000000,0.0000000,1.0000000,0.0000000],[0,0,0,0],[9E9,9E9,-850.1250,9E9,9E9,9E9]],v_am\V:=5.000,fine,t_am\WObj:=w_am;
    SetDO do1,0;
    ! layer 1
    MoveAbsJ [[0.5000,-30.0000,120.0000,0.0000,60.0000,0.0000],[9E9,9E9,-837.6250,9E9,9E9,9E9]]\NoEOffs,v_am\T:=0.50000,fine,t_am\WObj:=w_am;
    MoveAbsJ [[0.5000,-30.0000,120.0000,0.0000,60.0000,0.0000],[9E9,9E9,-825.1250,9E9,9E9,9E9]]\NoEOffs,v_am\T:=0.50000,fine,t_am\WObj:=w_am;
    SetDO do1,1;
    MoveL [[10.000,0.250,105.000],[1.0000000,0.0000000,0.0000000,0.0000000],[0,0,0,0],[9E9,9E9,-812.6250,9E9,9E9,9E9]],v_am\V:=5.000,z_am1,t_am\WObj:=w_am;
    MoveL [[12.000,0.250,106.000],[0.7071068,0.0000000,0.0000000,0.7071068],[0,0,0,0],[9E9,9E9,-800.1250,9E9,9E9,9E9]],v_am\V:=5.000,z_am1,t_am\WObj:=w_am;
    MoveL [[14.000,0.500,105.000],[0.0000000,0.0000000,1.0000000,0.0000000],[0,0,0,0],[9E9,9E9,-787.6250,9E9,9E9,9E9]],v_am\V:=5.000,fine,t_am\WObj:=w_am;
    SetDO do1,0;
  ENDPROC
ENDMODULE
