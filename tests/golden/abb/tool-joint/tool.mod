MODULE tool
  ! Robotic AM
  ! A remark ]]> with "marks": Grosse
  ! set the load of t_am: mass and centre of gravity of what the robot carries
  LOCAL PERS tooldata t_am:=[TRUE,[[0.000,0.000,150.000],[0.9689124,0.0000000,0.0000000,0.2474040]],[0.001,[0,0,0.001],[1,0,0,0],0,0,0]];
  LOCAL PERS wobjdata w_am:=[FALSE,TRUE,"",[[700.000,10.500,-100.000],[0.0752729,-0.0959412,-0.0566580,0.9909183]],[[0,0,0],[1,0,0,0]]];
  LOCAL CONST speeddata v_am:=[1000,500,5000,1000];
  LOCAL CONST zonedata z_am1:=[FALSE,0.600,0.600,0.600,0.0600,0.600,0.0600];
  PROC main()
    ConfL\Off;
    SingArea\Off;
    ! layer 0
    MoveAbsJ [[0.0000,-30.0000,120.0000,0.0000,60.0000,170.0000],[9E9,9E9,9E9,9E9,9E9,9E9]]\NoEOffs,v_am\T:=10.00000,fine,t_am\WObj:=w_am;
    MoveAbsJ [[1.2500,-29.5000,120.2500,0.1000,60.5000,175.0000],[9E9,9E9,9E9,9E9,9E9,9E9]]\NoEOffs,v_am\T:=0.80000,fine,t_am\WObj:=w_am;
    SetDO do3,1;
    WaitTime 0.500;
    MoveAbsJ [[1.2500,-29.5000,120.2500,0.1000,60.5000,176.0000],[9E9,9E9,9E9,9E9,9E9,9E9]]\NoEOffs,v_am\T:=0.20000,z_am1,t_am\WObj:=w_am;
    MoveAbsJ [[1.2500,-29.5000,120.3000,0.1000,60.5000,177.4000],[9E9,9E9,9E9,9E9,9E9,9E9]]\NoEOffs,v_am\T:=0.25000,fine,t_am\WObj:=w_am;
    WaitTime 0.250;
    SetDO do3,0;
    WaitTime 12.500;
    WaitDI di3,1;
    WaitAI ai2,\LT,1.250000;
    clean;
    ! layer 1
    MoveAbsJ [[0.0000,-30.0000,120.0000,0.0000,60.0000,177.4000],[9E9,9E9,9E9,9E9,9E9,9E9]]\NoEOffs,v_am\T:=1.00000,fine,t_am\WObj:=w_am;
  ENDPROC
ENDMODULE
