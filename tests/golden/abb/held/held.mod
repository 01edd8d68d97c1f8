MODULE held
  ! Robotic AM
  ! t_am is the nozzle, which stands; w_am is what the robot holds
  ! set the load of t_am: mass and centre of gravity of what the robot carries
  ! 2 parts of 2574 bytes in all, loaded from HOME:/ one after the other
  PROC main()
    Load \Dynamic,"HOME:/held01.mod";
    %"held01_p"%;
    UnLoad "HOME:/held01.mod";
    Load \Dynamic,"HOME:/held02.mod";
    %"held02_p"%;
    UnLoad "HOME:/held02.mod";
  ENDPROC
ENDMODULE
