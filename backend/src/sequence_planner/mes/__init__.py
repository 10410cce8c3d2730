"""Job orders of a MES, after ISA-95 Job Control (OPC 10031-4): what is ordered, what becomes of it, what was made."""
