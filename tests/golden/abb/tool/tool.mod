MODULE tool
  ! Robotic AM
  ! set the load of t_am: mass and centre of gravity of what the robot carries
  ! 2 parts of 2586 bytes in all, loaded from HOME:/ one after the other
  PROC main()
    Load \Dynamic,"HOME:/tool01.mod";
    %"tool01_p"%;
    UnLoad "HOME:/tool01.mod";
    Load \Dynamic,"HOME:/tool02.mod";
    %"tool02_p"%;
    UnLoad "HOME:/tool02.mod";
  ENDPROC
ENDMODULE
